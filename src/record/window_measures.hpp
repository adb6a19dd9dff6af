// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Takes the measures of one window of a run, or of the whole run (scenario/measures.hpp); and
// passes the pieces of a run to several sinks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "model/model.hpp"
#include "record/curve.hpp"
#include "record/extremes.hpp"
#include "record/instants.hpp"
#include "record/rows.hpp"
#include "scenario/measures.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Passes each piece to all sinks, in the order in which they were added.
class PieceFan : public solve::PieceSink {
 public:
  void clear() { sinks_.clear(); }
  void add(solve::PieceSink& sink) { sinks_.push_back(&sink); }
  void begin_run() override {
    for (solve::PieceSink* const sink : sinks_) sink->begin_run();
  }
  void accept(const solve::Piece& piece) override {
    for (solve::PieceSink* const sink : sinks_) sink->accept(piece);
  }
  [[nodiscard]] bool may_miss(solve::BoundsOfColumns& within) const override {
    return std::ranges::all_of(
        sinks_, [&](const solve::PieceSink* sink) { return sink->may_miss(within); });
  }
  // The sink for the pieces; null if there is none.
  [[nodiscard]] solve::PieceSink* sink() {
    if (sinks_.size() > 1) return this;
    return sinks_.empty() ? nullptr : sinks_.front();
  }

 private:
  std::vector<solve::PieceSink*> sinks_;
};

// Passes on each piece, or the part of it within the window, unless the part is shorter than the
// rounding of its time. Window and sink must outlive it.
class WindowPieces : public solve::PieceSink {
 public:
  WindowPieces(const scenario::Window& window, solve::PieceSink& sink)
      : window_(window), sink_(sink) {}
  void begin_run() override { sink_.begin_run(); }
  void accept(const solve::Piece& piece) override;
  [[nodiscard]] bool may_miss(solve::BoundsOfColumns& within) const override {
    return window_.is_whole() && sink_.may_miss(within);
  }

 private:
  const scenario::Window& window_;
  solve::PieceSink& sink_;
};

// The end of a run: its last row, or the instant at which an event stopped it.
struct RunEnd {
  double t;  // s
  model::Sample sample;
};

// Takes the measures of one window, of one run after another. All measures but `end` ignore NaN; a
// measure without a value is NaN.
class WindowMeasures {
 public:
  // `which` has the indices of the window's measures.
  WindowMeasures(const std::vector<scenario::Measure>& measures, std::vector<std::size_t> which);
  WindowMeasures(const WindowMeasures&) = delete;  // members refer to each other
  WindowMeasures& operator=(const WindowMeasures&) = delete;

  // Begins a run. Model and constants must outlive it. Adds the sinks that need its pieces to the
  // fan.
  void begin(const model::Model& model, const model::BallConstants& constants, PieceFan& fan);

  // The columns whose rows are needed, in the order of accept_rows().
  [[nodiscard]] std::vector<const scenario::Column*> row_columns() const;
  // Takes the first row of the run, which may belong to no piece.
  void accept_start(double t, const double* row);
  // Takes some rows: column(k) has the values of row_columns()[k].
  template <class ColumnOf>
  void accept_rows(const std::vector<double>& times, ColumnOf column) {
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      for (std::size_t i = 0; i < times.size(); ++i) sums_[k].add(window_, times[i], column(k)[i]);
    }
  }

  // Writes the measures to their indices among all.
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
  std::vector<std::size_t> places_;          // index of each among all
  scenario::Window window_;
  // Indices into measures_: values at the end, extremes, means, and step metrics and instants.
  std::vector<std::size_t> at_end_, of_motion_, of_rows_, of_curves_;
  Rows end_;
  Extremes extremes_;
  Traces traces_;
  WindowPieces extreme_pieces_, trace_pieces_;
  std::vector<Sum> sums_;  // for each of of_rows_
  const model::Model* model_ = nullptr;
};

}  // namespace bbsim::record
