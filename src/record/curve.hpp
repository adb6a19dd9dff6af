// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A number of a run over time: finds crossings of levels and extremes; and columns that are
// followed over the motion of a run as such curves.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/maxima.hpp"
#include "model/model.hpp"
#include "record/rows.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Consists of pieces in order of time, possibly with jumps between them. A piece is a polynomial
// through values at Chebyshev points, a straight line between rows of a file, or an instant. A
// query cuts the pieces into monotone arcs whose bounds do not answer it.
class Curve {
 public:
  // An instant on one of the pieces. Curves of one run have the same pieces.
  struct Place {
    double t;  // s
    std::size_t piece;
    double part;  // of the piece, from 0 to 1
  };
  struct Extreme {
    double value;
    double t;  // s
  };

  void clear();
  // Pieces with a value that is not finite are ignored by all queries but last_value().
  void add_piece(double from, double to, const ChebyshevPoints& points, const double* values);
  void add_line(double from, double to, double from_value, double to_value);
  // Sets the value at the very end, after a switch there.
  void end_at(double t, double value);

  [[nodiscard]] bool empty() const { return first_ == none; }
  [[nodiscard]] double start() const { return pieces_[first_].from; }
  [[nodiscard]] double start_value() const { return values_[pieces_[first_].first]; }
  [[nodiscard]] double end_value() const { return value(last_, 1); }
  // The value at the end of the last piece, even if it is not finite; NaN if there is no piece.
  [[nodiscard]] double last_value() const;

  // A value that exceeds a level by no more than the rounding of its piece is at the level.
  // Reaching a level is not crossing it.

  // The first instant at which sign * value >= level.
  [[nodiscard]] std::optional<Place> first_at_least(double sign, double level) const;
  // The last instant at which sign * value >= level.
  [[nodiscard]] std::optional<Place> last_at_least(double sign, double level) const;
  // Whether sign * value >= level at the end.
  [[nodiscard]] bool ends_at_least(double sign, double level) const;
  // The instant at which the curve crosses the level for the number-th time, counted from 1; 0
  // means the last time. Neither a turn at the level nor a start at it is a crossing.
  [[nodiscard]] std::optional<Place> crossing(double level, scenario::Instant::Way way,
                                              std::size_t number) const;
  // The value for which sign * value is greatest, from `from` or the start on, and its first time.
  [[nodiscard]] Extreme greatest(double sign, const std::optional<Place>& from = {}) const;
  // The value at a place of this curve or of another curve of the run.
  [[nodiscard]] double value(const Place& place) const;
  // The place at a time (s). At a jump, it is the place after the jump.
  [[nodiscard]] std::optional<Place> place_at(double t) const;

 private:
  struct Piece {
    double from, to;                // s
    const ChebyshevPoints* points;  // null for a straight line
    std::size_t first;              // index of its first value
    // Bounds of its values, and of their rounding errors. Not numbers if a value is not finite.
    double least, most, rounding;
  };
  struct Arc {
    Place from, to;
    double from_value, to_value;
  };
  // The monotone arcs of a piece, and the greatest rounding error of a value within it.
  struct Arcs {
    std::vector<Arc> arcs{};
    double rounding = 0;
    // The side of the level on which a value is: 1, -1, or 0 if it is at the level.
    [[nodiscard]] int side(double value, double level) const;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  void add(const Piece& piece, const double* values, std::size_t count);
  void add_line(double from, double to, double from_value, double to_value, double rounding);
  [[nodiscard]] double value(std::size_t piece, double part) const;
  [[nodiscard]] Place place(std::size_t piece, double part) const;
  [[nodiscard]] Arcs arcs_of(std::size_t piece) const;
  // Whether sign * value may reach the level within a piece; false if a value is not finite.
  [[nodiscard]] bool may_reach(const Piece& piece, double sign, double level) const;
  // Where the arc is at the level. At most one of its ends is at the level.
  [[nodiscard]] Place at_level(const Arcs& of, const Arc& arc, double level) const;

  std::vector<Piece> pieces_;
  std::vector<double> values_;
  std::size_t first_ = none, last_ = none;  // pieces whose values are finite
};

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
