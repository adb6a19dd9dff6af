// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Follows columns over the continuous motion of a run and keeps them as curves.
#pragma once

#include <cstddef>
#include <vector>

#include "base/maxima.hpp"
#include "model/model.hpp"
#include "record/curve.hpp"
#include "record/rows.hpp"
#include "scenario/columns.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Evaluates each piece at enough points to represent its columns to rounding, or at 64 intervals
// where they are not smooth.
class Traces : public solve::PieceSink {
 public:
  // Of the columns `ends`, keeps only the last value. No column may need orientations, which depend
  // on the rows before.
  Traces(std::vector<const scenario::Column*> columns, std::vector<const scenario::Column*> ends);

  // Begins a run. Both arguments must outlive it.
  void begin(const model::Model& model, const model::BallConstants& constants);
  void begin_run() override;
  void accept(const solve::Piece& piece) override;
  // Ends the run at `t` (s) with this sample. If the run ended before its first step, the curves
  // have only this point.
  void finish(double t, const model::Sample& last);

  [[nodiscard]] bool empty() const { return columns_.columns().empty(); }
  [[nodiscard]] const Curve& of(const scenario::Column& column) const;

 private:
  void sample(const solve::Piece& piece, const ChebyshevPoints& points, std::size_t stride);

  Rows columns_, ends_;
  ChebyshevTables tables_;
  std::vector<Curve> curves_, last_;
  std::vector<std::vector<double>> values_;  // of each column at the points of a piece
  std::vector<double> times_;
};

}  // namespace bbsim::record
