// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/instant.hpp"

namespace bbsim::record {
namespace {

// The zero of `f` by bisection, to rounding. `f` has different signs at both ends and is 0 at
// neither.
template <class Function>
double root(double low, double high, Function f) {
  const double rising = f(low) < 0 ? 1 : -1;  // a falling function rises after a change of sign
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return middle;
    (rising * f(middle) < 0 ? low : high) = middle;
  }
}

// The greatest rounding error of a value of a piece, in two parts. The polynomial's error is at
// most (6 n + 6) u times the Lebesgue constant and the largest value at the n + 1 points (Higham,
// IMA J. Numer. Anal. 24:547, 2004). A switch at the end of a piece has a rounded time, during
// which the value changes at most at its steepest slope.
double rounding_of_piece(double from, double to, const ChebyshevPoints& points,
                         const double* values, const double* slopes) {
  const std::size_t count = points.size();
  double size = 0, steepest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    size = std::max(size, std::abs(values[i]));
    steepest = std::max(steepest, std::abs(slopes[i]));
  }
  constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
  const double lebesgue = 1 + 2 * points.overshoot();
  const double of_polynomial = 6 * static_cast<double>(count) * unit_roundoff * lebesgue * size;
  const auto [least, most] = std::minmax_element(values, values + count);
  // A piece as short as the rounding of its time changes by no more than its range.
  const double part = to - from > rounding_of(to) ? rounding_of(to) / (to - from) : 1;
  return of_polynomial + std::min(part * steepest, *most - *least);
}

}  // namespace

void Curve::clear() {
  pieces_.clear();
  values_.clear();
  arcs_.clear();
}

double Curve::value(std::size_t piece, double part) const {
  const Piece& of = pieces_[piece];
  const double* const values = &values_[of.first];
  if (of.points != nullptr) return of.points->at(values, part);
  return part == 1 ? values[1] : values[0] + (values[1] - values[0]) * part;
}

double Curve::value(const Place& place) const {
  return value(place.piece, place.part);
}

double Curve::last_value() const {
  if (pieces_.empty()) return std::numeric_limits<double>::quiet_NaN();
  return value(pieces_.size() - 1, 1);
}

Curve::Place Curve::place(std::size_t piece, double part) const {
  const Piece& of = pieces_[piece];
  return {part == 1 ? of.to : of.from + (of.to - of.from) * part, piece, part};
}

void Curve::add_line(double from, double to, double from_value, double to_value) {
  add_line(from, to, from_value, to_value, 0);
}

void Curve::end_at(double t, double value) {
  if (empty()) return add_line(t, t, value, value);
  add_line(t, t, end_value(), value, pieces_[arcs_.back().to.piece].rounding);
}

void Curve::add_line(double from, double to, double from_value, double to_value, double rounding) {
  const std::size_t number = pieces_.size();
  pieces_.push_back({from, to, nullptr, values_.size(), rounding});
  values_.insert(values_.end(), {from_value, to_value});
  if (!std::isfinite(from_value) || !std::isfinite(to_value)) return;
  arcs_.push_back({place(number, 0), place(number, 1), from_value, to_value});
}

void Curve::add_piece(double from, double to, const ChebyshevPoints& points, const double* values) {
  const std::size_t number = pieces_.size(), count = points.size();
  pieces_.push_back({from, to, &points, values_.size(), 0});
  values_.insert(values_.end(), values, values + count);
  if (!std::all_of(values, values + count, [](double value) { return std::isfinite(value); })) {
    return;
  }
  slopes_.resize(count);
  points.slopes(values, slopes_.data());
  pieces_.back().rounding = rounding_of_piece(from, to, points, values, slopes_.data());
  Arc arc{place(number, 0), {}, values[0], 0};
  const auto end_arc = [&](double part, double value) {
    arc.to = place(number, part);
    arc.to_value = value;
    arcs_.push_back(arc);
    arc.from = arc.to;
    arc.from_value = value;
  };
  const auto slope = [&](double part) { return points.at(slopes_.data(), part); };
  const auto look_between = [&](double low, double low_slope, double high, double high_slope) {
    if (low_slope * high_slope >= 0) return;
    const double turn = root(low, high, slope);
    end_arc(turn, this->value(number, turn));
  };
  // The slope changes its sign at each turn, at the points and between them.
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double middle = points[i] + (points[i + 1] - points[i]) / 2;
    const double middle_slope = slope(middle);
    look_between(points[i], slopes_[i], middle, middle_slope);
    look_between(middle, middle_slope, points[i + 1], slopes_[i + 1]);
    // A turn exactly at a point.
    if (i + 2 < count && slopes_[i + 1] == 0) end_arc(points[i + 1], values[i + 1]);
  }
  end_arc(1, values[count - 1]);
}

int Curve::side(double value, double level, std::size_t piece) const {
  if (std::abs(value - level) <= pieces_[piece].rounding) return 0;
  return value > level ? 1 : value < level ? -1 : 0;
}

Curve::Place Curve::at_level(const Arc& arc, double level) const {
  const std::size_t piece = arc.from.piece;
  if (side(arc.from_value, level, piece) == 0) return arc.from;
  if (side(arc.to_value, level, piece) == 0 || arc.from.part == arc.to.part) return arc.to;
  return place(piece, root(arc.from.part, arc.to.part,
                           [&](double part) { return value(piece, part) - level; }));
}

std::optional<Curve::Place> Curve::first_at_least(double sign, double level) const {
  for (const Arc& arc : arcs_) {
    const auto is_below = [&](double value) {
      return side(sign * value, level, arc.from.piece) < 0;
    };
    if (!is_below(arc.from_value)) return arc.from;
    if (!is_below(arc.to_value)) return at_level(arc, sign * level);
  }
  return {};
}

std::optional<Curve::Place> Curve::last_at_least(double sign, double level) const {
  for (auto arc = arcs_.rbegin(); arc != arcs_.rend(); ++arc) {
    const auto is_below = [&](double value) {
      return side(sign * value, level, arc->from.piece) < 0;
    };
    if (!is_below(arc->to_value)) return arc->to;
    if (!is_below(arc->from_value)) return at_level(*arc, sign * level);
  }
  return {};
}

bool Curve::ends_at_least(double sign, double level) const {
  return side(sign * end_value(), level, arcs_.back().to.piece) >= 0;
}

std::optional<Curve::Place> Curve::crossing(double level, scenario::Instant::Way way,
                                            std::size_t number) const {
  using Way = scenario::Instant::Way;
  std::optional<Place> last, reached;  // reached: where the curve came to the level and stayed
  int side_before = 0;                 // the side of the level before
  std::size_t found = 0;
  const auto look = [&](int now, const Place& at) {
    if (now == 0) {
      if (!reached) reached = at;
      return false;
    }
    const bool crosses = side_before * now < 0;
    const bool counts = crosses && (way == Way::either || (way == Way::rise) == (now > 0));
    if (counts) last = reached ? *reached : at;
    side_before = now;
    reached.reset();
    return counts && ++found == number;
  };
  for (const Arc& arc : arcs_) {
    const int from = side(arc.from_value, level, arc.from.piece);
    const int to = side(arc.to_value, level, arc.from.piece);
    if (look(from, arc.from)) return last;
    if (look(to, from * to < 0 ? at_level(arc, level) : arc.to)) return last;
  }
  return number == 0 ? last : std::nullopt;
}

Curve::Extreme Curve::greatest(double sign, const std::optional<Place>& from) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Extreme best{none, none};
  const auto take = [&](double value, double t) {
    if (!(sign * value <= sign * best.value)) best = {value, t};
  };
  if (from) take(value(*from), from->t);
  for (const Arc& arc : arcs_) {
    if (from &&
        (arc.to.piece < from->piece || (arc.to.piece == from->piece && arc.to.part < from->part))) {
      continue;
    }
    const bool within = from && arc.from.piece == from->piece && arc.from.part < from->part;
    if (!within) take(arc.from_value, arc.from.t);
    take(arc.to_value, arc.to.t);
  }
  return best;
}

std::optional<Curve::Place> Curve::place_at(double t) const {
  if (pieces_.empty() || !(t >= pieces_.front().from)) return {};
  // The last piece that has begun. A gap between two pieces is a switch, as short as rounding.
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), t,
                       [](double time, const Piece& piece) { return time < piece.from; });
  const auto number = static_cast<std::size_t>(after - pieces_.begin()) - 1;
  const Piece& of = pieces_[number];
  if (after == pieces_.end() && t > of.to) return {};
  const double length = of.to - of.from;
  return Place{t, number, length > 0 ? std::clamp((t - of.from) / length, 0.0, 1.0) : 1.0};
}

}  // namespace bbsim::record
