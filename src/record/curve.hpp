// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A number of a run over time, as arcs on each of which it only rises or only falls: what crosses
// what, when, and how far it goes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/chebyshev.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// Made of pieces in order of time, which may jump from one to the next. A piece is a polynomial
// through values at Chebyshev points, a straight line between rows of a file, or an instant.
class Curve {
 public:
  // An instant of the curve, on one of its pieces. Curves of one run have the same pieces.
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
  // Pieces with a value that is no finite number are left out of all that is asked.
  void add_piece(double from, double to, const ChebyshevPoints& points, const double* values);
  void add_line(double from, double to, double from_value, double to_value);
  // What the curve is worth at its very end, after what switches there.
  void end_at(double t, double value);

  [[nodiscard]] bool empty() const { return arcs_.empty(); }
  [[nodiscard]] double start() const { return arcs_.front().from.t; }
  [[nodiscard]] double start_value() const { return arcs_.front().from_value; }
  [[nodiscard]] double end_value() const { return arcs_.back().to_value; }
  // That at the end of the last piece, even where it is no finite number, or there is no piece.
  [[nodiscard]] double last_value() const;

  // Where a piece comes no further beyond a level than its rounding, it stands at the level: that
  // is no crossing of it.

  // The first instant at which sign * value >= level.
  [[nodiscard]] std::optional<Place> first_at_least(double sign, double level) const;
  // The last one.
  [[nodiscard]] std::optional<Place> last_at_least(double sign, double level) const;
  // Whether the end is one.
  [[nodiscard]] bool ends_at_least(double sign, double level) const;
  // The instant at which the curve passes through the level for the number-th time, from 1; 0 is
  // the last time. It does not where it turns back, and not at its start.
  [[nodiscard]] std::optional<Place> crossing(double level, scenario::Instant::Way way,
                                              std::size_t number) const;
  // The greatest sign * value from there on (from the start where there is no place), and its
  // first time.
  [[nodiscard]] Extreme greatest(double sign, const std::optional<Place>& from = {}) const;
  // The value at a place, of this curve or another one of the run.
  [[nodiscard]] double value(const Place& place) const;
  // At a time; of an instant at which it jumps, after it.
  [[nodiscard]] std::optional<Place> place_at(double t) const;

 private:
  struct Piece {
    double from, to;                // s
    const ChebyshevPoints* points;  // null of a straight line
    std::size_t first;              // of its values
    double rounding;                // of a value between its ends
  };
  struct Arc {
    Place from, to;
    double from_value, to_value;
  };
  [[nodiscard]] double value(std::size_t piece, double part) const;
  [[nodiscard]] Place place(std::size_t piece, double part) const;
  // The side of the level that a value of a piece is on: 1, -1, or 0 where it stands at it.
  [[nodiscard]] int side(double value, double level, std::size_t piece) const;
  // Where the arc, of whose ends one at most stands at the level, is at it.
  [[nodiscard]] Place at_level(const Arc& arc, double level) const;
  void add_line(double from, double to, double from_value, double to_value, double rounding);

  std::vector<Piece> pieces_;
  std::vector<double> values_, slopes_;  // slopes_: of the piece that is added
  std::vector<Arc> arcs_;
};

}  // namespace bbsim::record
