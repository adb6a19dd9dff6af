// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of one window of a run, or of the whole of it (scenario/measures.hpp).
#pragma once

#include <cstddef>
#include <vector>

#include "model/model.hpp"
#include "record/extremes.hpp"
#include "record/instants.hpp"
#include "record/piece_fan.hpp"
#include "record/rows.hpp"
#include "record/square_sum.hpp"
#include "record/traces.hpp"
#include "record/window_pieces.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// Where a run ended: the row there, or the instant at which it was stopped.
struct RunEnd {
  double t;  // s
  model::Sample sample;
};

// Takes measures of one window, of one run after another. Values that are no number are left out,
// but for `end`; a measure without a value is no number.
class WindowMeasures {
 public:
  // `which` of the measures are of the window.
  WindowMeasures(const std::vector<scenario::Measure>& measures, std::vector<std::size_t> which);
  WindowMeasures(const WindowMeasures&) = delete;  // its pieces go to this one's
  WindowMeasures& operator=(const WindowMeasures&) = delete;

  // Begins a run; both outlive it. Adds those to the fan who look at its pieces.
  void begin(const model::Model& model, const model::BallConstants& constants, PieceFan& fan);

  // The columns whose rows are wanted, in the order in which accept_rows() gets them.
  [[nodiscard]] std::vector<const scenario::Column*> row_columns() const;
  // The first row of the run, which may be of no piece.
  void accept_start(double t, const double* row);
  // column(k) is that of row_columns()[k] in so many rows.
  template <class ColumnOf>
  void accept_rows(const std::vector<double>& times, ColumnOf column) {
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      for (std::size_t i = 0; i < times.size(); ++i) sums_[k].add(window_, times[i], column(k)[i]);
    }
  }

  // Writes the measures to their places among all.
  void finish(const RunEnd& end, double* results, scenario::Whys& whys);

 private:
  struct Sum {
    std::size_t rows = 0;
    SquareSum squares{};
    void add(const scenario::Window& window, double t, double value);
  };

  void put(std::size_t which, const Measured& measured, double* results,
           scenario::Whys& whys) const;
  [[nodiscard]] const Curve& curve_of(const scenario::Column& column) const;

  std::vector<scenario::Measure> measures_;  // of the window
  std::vector<std::size_t> places_;          // of each among all
  scenario::Window window_;
  // Which of measures_: at the end, extremes, means, and step metrics and instants.
  std::vector<std::size_t> at_end_, of_motion_, of_rows_, of_curves_;
  Rows end_;
  Extremes extremes_;
  Traces traces_;
  Rows traces_end_;
  WindowPieces extreme_pieces_, trace_pieces_;
  std::vector<Sum> sums_;  // of of_rows_
  const model::Model* model_ = nullptr;
};

}  // namespace bbsim::record
