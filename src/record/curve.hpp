// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A number of a run over time, cut into monotone arcs. Finds crossings of levels and extremes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/chebyshev.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// Consists of pieces in order of time, possibly with jumps between them. A piece is a polynomial
// through values at Chebyshev points, a straight line between rows of a file, or an instant.
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

  [[nodiscard]] bool empty() const { return arcs_.empty(); }
  [[nodiscard]] double start() const { return arcs_.front().from.t; }
  [[nodiscard]] double start_value() const { return arcs_.front().from_value; }
  [[nodiscard]] double end_value() const { return arcs_.back().to_value; }
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
    double rounding;                // greatest rounding error of a value within it
  };
  struct Arc {
    Place from, to;
    double from_value, to_value;
  };
  [[nodiscard]] double value(std::size_t piece, double part) const;
  [[nodiscard]] Place place(std::size_t piece, double part) const;
  // The side of the level on which a value of a piece is: 1, -1, or 0 if it is at the level.
  [[nodiscard]] int side(double value, double level, std::size_t piece) const;
  // Where the arc is at the level. At most one of its ends is at the level.
  [[nodiscard]] Place at_level(const Arc& arc, double level) const;
  void add_line(double from, double to, double from_value, double to_value, double rounding);

  std::vector<Piece> pieces_;
  std::vector<double> values_, slopes_;  // slopes_: of the piece being added
  std::vector<Arc> arcs_;
};

}  // namespace bbsim::record
