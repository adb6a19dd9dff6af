// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/instant.hpp"
#include "base/real.hpp"

namespace bbsim::record {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

// The rounding error of a polynomial through values of this size: at most (6 n + 6) u times the
// Lebesgue constant and the largest value at the n + 1 points (Higham, IMA J. Numer. Anal. 24:547,
// 2004).
double rounding_of_polynomial(const ChebyshevPoints& points, double size) {
  const double lebesgue = 1 + 2 * points.overshoot();
  return 6 * static_cast<double>(points.size()) * unit_roundoff * lebesgue * size;
}

// A switch at the end of a piece has a rounded time, during which the value changes at most at its
// steepest slope.
double rounding_of_switch(double from, double to, double steepest, double range) {
  // A piece as short as the rounding of its time changes by no more than its range.
  const double part = to - from > rounding_of(to) ? rounding_of(to) / (to - from) : 1;
  return std::min(part * steepest, range);
}

constexpr std::size_t most_intervals = 64;
// Points suffice if the remainder is at most this part of the values.
constexpr double unseen = 1e-14;

}  // namespace

void Curve::clear() {
  pieces_.clear();
  values_.clear();
  first_ = last_ = none;
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
  if (pieces_.empty()) return no_number;
  return value(pieces_.size() - 1, 1);
}

Curve::Place Curve::place(std::size_t piece, double part) const {
  const Piece& of = pieces_[piece];
  return {part == 1 ? of.to : of.from + (of.to - of.from) * part, piece, part};
}

void Curve::add(const Piece& piece, const double* values, std::size_t count) {
  const std::size_t number = pieces_.size();
  pieces_.push_back(piece);
  values_.insert(values_.end(), values, values + count);
  Piece& of = pieces_.back();
  of.least = of.most = values[0];
  bool finite = true;
  for (std::size_t i = 0; i < count; ++i) {
    finite = finite && std::isfinite(values[i]);
    of.least = std::min(of.least, values[i]);
    of.most = std::max(of.most, values[i]);
  }
  if (!finite) {
    of.least = of.most = no_number;
    return;
  }
  if (of.points != nullptr) {
    const double range = of.most - of.least, beyond = of.points->overshoot() * range;
    of.rounding = rounding_of_polynomial(*of.points, std::max(-of.least, of.most)) + range;
    of.least -= beyond;
    of.most += beyond;
  }
  if (first_ == none) first_ = number;
  last_ = number;
}

void Curve::add_line(double from, double to, double from_value, double to_value) {
  add_line(from, to, from_value, to_value, 0);
}

void Curve::end_at(double t, double value) {
  if (empty()) return add_line(t, t, value, value);
  add_line(t, t, end_value(), value, arcs_of(last_).rounding);
}

void Curve::add_line(double from, double to, double from_value, double to_value, double rounding) {
  const double values[] = {from_value, to_value};
  add({from, to, nullptr, values_.size(), 0, 0, rounding}, values, 2);
}

void Curve::add_piece(double from, double to, const ChebyshevPoints& points, const double* values) {
  add({from, to, &points, values_.size(), 0, 0, 0}, values, points.size());
}

Curve::Arcs Curve::arcs_of(std::size_t number) const {
  const Piece& of = pieces_[number];
  const double* const values = &values_[of.first];
  Arcs found;
  if (of.points == nullptr) {
    found.rounding = of.rounding;
    found.arcs.push_back({place(number, 0), place(number, 1), values[0], values[1]});
    return found;
  }
  const ChebyshevPoints& points = *of.points;
  const std::size_t count = points.size();
  std::vector<double> slopes(count);
  points.slopes(values, slopes.data());
  double size = 0, steepest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    size = std::max(size, std::abs(values[i]));
    steepest = std::max(steepest, std::abs(slopes[i]));
  }
  const auto [least, most] = std::minmax_element(values, values + count);
  found.rounding = rounding_of_polynomial(points, size) +
                   rounding_of_switch(of.from, of.to, steepest, *most - *least);
  Arc arc{place(number, 0), {}, values[0], 0};
  const auto end_arc = [&](double part, double value) {
    arc.to = place(number, part);
    arc.to_value = value;
    found.arcs.push_back(arc);
    arc.from = arc.to;
    arc.from_value = value;
  };
  const auto slope = [&](double part) { return points.at(slopes.data(), part); };
  const auto look_between = [&](double low, double low_slope, double high, double high_slope) {
    if (low_slope * high_slope >= 0) return;
    const double turn = zero_between(low, high, slope);
    end_arc(turn, this->value(number, turn));
  };
  // The slope changes its sign at each turn, at the points and between them.
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double middle = points[i] + (points[i + 1] - points[i]) / 2;
    const double middle_slope = slope(middle);
    look_between(points[i], slopes[i], middle, middle_slope);
    look_between(middle, middle_slope, points[i + 1], slopes[i + 1]);
    // A turn exactly at a point.
    if (i + 2 < count && slopes[i + 1] == 0) end_arc(points[i + 1], values[i + 1]);
  }
  end_arc(1, values[count - 1]);
  return found;
}

int Curve::Arcs::side(double value, double level) const {
  if (std::abs(value - level) <= rounding) return 0;
  return value > level ? 1 : value < level ? -1 : 0;
}

bool Curve::may_reach(const Piece& piece, double sign, double level) const {
  return (sign > 0 ? piece.most : -piece.least) + piece.rounding >= level;
}

Curve::Place Curve::at_level(const Arcs& of, const Arc& arc, double level) const {
  const std::size_t piece = arc.from.piece;
  if (of.side(arc.from_value, level) == 0) return arc.from;
  if (of.side(arc.to_value, level) == 0 || arc.from.part == arc.to.part) return arc.to;
  return place(piece, zero_between(arc.from.part, arc.to.part,
                                   [&](double part) { return value(piece, part) - level; }));
}

std::optional<Curve::Place> Curve::first_at_least(double sign, double level) const {
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
    if (!may_reach(pieces_[piece], sign, level)) continue;
    const Arcs of = arcs_of(piece);
    for (const Arc& arc : of.arcs) {
      if (of.side(sign * arc.from_value, level) >= 0) return arc.from;
      if (of.side(sign * arc.to_value, level) >= 0) return at_level(of, arc, sign * level);
    }
  }
  return {};
}

std::optional<Curve::Place> Curve::last_at_least(double sign, double level) const {
  for (std::size_t piece = pieces_.size(); piece-- > 0;) {
    if (!may_reach(pieces_[piece], sign, level)) continue;
    const Arcs of = arcs_of(piece);
    for (auto arc = of.arcs.rbegin(); arc != of.arcs.rend(); ++arc) {
      if (of.side(sign * arc->to_value, level) >= 0) return arc->to;
      if (of.side(sign * arc->from_value, level) >= 0) return at_level(of, *arc, sign * level);
    }
  }
  return {};
}

bool Curve::ends_at_least(double sign, double level) const {
  return arcs_of(last_).side(sign * end_value(), level) >= 0;
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
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const bool above = may_reach(piece, 1, level), below = may_reach(piece, -1, -level);
    if (!above && !below) continue;  // not finite
    if (above != below) {            // all of it is on one side
      if (look(above ? 1 : -1, place(i, 0))) return last;
      continue;
    }
    const Arcs of = arcs_of(i);
    for (const Arc& arc : of.arcs) {
      const int from = of.side(arc.from_value, level), to = of.side(arc.to_value, level);
      if (look(from, arc.from)) return last;
      if (look(to, from * to < 0 ? at_level(of, arc, level) : arc.to)) return last;
    }
  }
  return number == 0 ? last : std::nullopt;
}

Curve::Extreme Curve::greatest(double sign, const std::optional<Place>& from) const {
  Extreme best{no_number, no_number};
  const auto take = [&](double value, double t) {
    if (!(sign * value <= sign * best.value)) best = {value, t};
  };
  if (from) take(value(*from), from->t);
  for (std::size_t piece = from ? from->piece : 0; piece < pieces_.size(); ++piece) {
    const Piece& of = pieces_[piece];
    // No value is greater, or one is not finite.
    if (!((sign > 0 ? of.most : -of.least) > sign * best.value) &&
        (!std::isnan(best.value) || std::isnan(of.most))) {
      continue;
    }
    for (const Arc& arc : arcs_of(piece).arcs) {
      const bool begins_before = from && piece == from->piece && arc.from.part < from->part;
      if (begins_before && arc.to.part < from->part) continue;
      if (!begins_before) take(arc.from_value, arc.from.t);
      take(arc.to_value, arc.to.t);
    }
  }
  return best;
}

std::optional<Curve::Place> Curve::place_at(double t) const {
  if (pieces_.empty() || !(t >= pieces_.front().from)) return {};
  // The last piece that has begun. A gap between two pieces is a switch, as short as rounding.
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), t,
                       [](double time, const Piece& piece) { return time < piece.from; });
  auto number = static_cast<std::size_t>(after - pieces_.begin()) - 1;
  // A row before empty cells has a value, but no line begins at it.
  if (number > 0 && std::isnan(pieces_[number].most) && pieces_[number - 1].to == t) --number;
  const Piece& of = pieces_[number];
  if (after == pieces_.end() && t > of.to) return {};
  const double length = of.to - of.from;
  return Place{t, number, length > 0 ? std::clamp((t - of.from) / length, 0.0, 1.0) : 1.0};
}

Traces::Traces(std::vector<const scenario::Column*> columns,
               std::vector<const scenario::Column*> ends)
    : columns_(std::move(columns)),
      ends_(std::move(ends)),
      curves_(columns_.columns().size()),
      last_(ends_.columns().size()),
      values_(curves_.size()) {}

void Traces::begin(const model::Model& model, const model::BallConstants& constants) {
  columns_.begin(model, constants);
  ends_.begin(model, constants);
  begin_run();
}

void Traces::begin_run() {
  for (std::vector<Curve>* const curves : {&curves_, &last_}) {
    for (Curve& curve : *curves) curve.clear();
  }
}

const Curve& Traces::of(const scenario::Column& column) const {
  const auto traced = std::ranges::find(columns_.columns(), &column);
  if (traced != columns_.columns().end()) {
    return curves_[static_cast<std::size_t>(traced - columns_.columns().begin())];
  }
  return last_[static_cast<std::size_t>(std::ranges::find(ends_.columns(), &column) -
                                        ends_.columns().begin())];
}

void Traces::accept(const solve::Piece& piece) {
  if (!last_.empty()) {
    const double t = piece.to();
    ends_.evaluate(piece, &t, 1);
    for (std::size_t i = 0; i < last_.size(); ++i) {
      last_[i].clear();
      last_[i].add_line(t, t, ends_[i][0], ends_[i][0]);
    }
  }
  const auto shows = [](const std::vector<double>& values, const ChebyshevPoints& points) {
    double size = 0;
    for (const double value : values) size = std::max(size, std::abs(value));
    return !(points.tail(values.data()) > unseen * size);
  };
  for (std::size_t parts = piece.parts(), stride = 1;; parts *= 2, stride = 2) {
    const ChebyshevPoints& points = tables_.points(parts);
    sample(piece, points, stride);
    bool enough = true;
    for (std::size_t i = 0; enough && i < curves_.size(); ++i) enough = shows(values_[i], points);
    if (!enough && 2 * parts <= most_intervals) continue;
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      curves_[i].add_piece(piece.from(), piece.to(), points, values_[i].data());
    }
    return;
  }
}

// Evaluates the columns at all points, or with a stride of 2 at each second one: the others have
// the values of half as many points.
void Traces::sample(const solve::Piece& piece, const ChebyshevPoints& points, std::size_t stride) {
  const std::size_t first = stride - 1;
  times_.clear();
  for (std::size_t p = first; p < points.size(); p += stride) {
    times_.push_back(piece.from() + (piece.to() - piece.from()) * points[p]);
  }
  if (first == 0) times_.back() = piece.to();
  columns_.evaluate(piece, times_.data(), times_.size());
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    std::vector<double>& values = values_[i];
    values.resize(points.size());
    for (std::size_t p = points.size() / 2 + 1; stride == 2 && p-- > 0;) values[2 * p] = values[p];
    for (std::size_t k = 0; k < times_.size(); ++k) values[first + k * stride] = columns_[i][k];
  }
}

void Traces::finish(double t, const model::Sample& last) {
  columns_.evaluate(last);
  ends_.evaluate(last);
  for (std::size_t i = 0; i < curves_.size(); ++i) curves_[i].end_at(t, columns_[i][0]);
  for (std::size_t i = 0; i < last_.size(); ++i) last_[i].end_at(t, ends_[i][0]);
}

}  // namespace bbsim::record
