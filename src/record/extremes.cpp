// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "base/real.hpp"

namespace bbsim::record {
namespace {

// Bounds on the number of intervals. Points are doubled while they do not resolve a column.
constexpr std::size_t fewest_parts = 8, most_parts = 64;
// Points resolve a column if the remainder is at most this part of its range. No maximum is then
// missed.
constexpr double shown = 1e-4;
// Smaller relative differences are due to rounding.
constexpr double rounding = 1e-14;

std::vector<const scenario::Column*> columns_of(const std::vector<Extremes::Query>& queries) {
  std::vector<const scenario::Column*> columns;
  for (const Extremes::Query& query : queries) columns.push_back(query.column);
  return columns;
}

double time_of(const solve::Piece& piece, const ChebyshevPoints& points, std::size_t p) {
  return p + 1 == points.size() ? piece.to()
                                : piece.from() + (piece.to() - piece.from()) * points[p];
}

std::optional<solve::Bounded> bounded(std::string_view column) {
  using solve::Bounded;
  constexpr std::pair<std::string_view, Bounded> known[] = {
      {"x", Bounded::x},
      {"y", Bounded::y},
      {"vx", Bounded::vx},
      {"vy", Bounded::vy},
      {"distance", Bounded::distance},
      {"tilt", Bounded::tilt},
      {"tilt_rate", Bounded::tilt_rate},
      {"tracking_error", Bounded::tracking_error},
      {"motor_torque_phi", Bounded::motor_torque_phi},
      {"motor_torque_theta", Bounded::motor_torque_theta},
      {"motor_power", Bounded::motor_power},
  };
  for (const auto& [name, bound] : known) {
    if (name == column) return bound;
  }
  return {};
}

}  // namespace

Extremes::Extremes(std::vector<Query> queries)
    : columns_(columns_of(queries)), greatest_(queries.size()) {
  for (const Query& query : queries) {
    signs_.push_back(query.least ? -1 : 1);
    bounded_.push_back(bounded(query.column->name));
  }
  begin_run();
}

void Extremes::begin(const model::Model& model, const model::BallConstants& constants) {
  constants_ = &constants;
  columns_.begin(model, constants);
  begin_run();
}

void Extremes::begin_run() {
  std::fill(greatest_.begin(), greatest_.end(), Extreme{no_number, no_number});
}

void Extremes::take(std::size_t i, double value, double t) {
  Extreme& greatest = greatest_[i];
  if (value > greatest.value || (std::isnan(greatest.value) && !std::isnan(value))) {
    greatest = {value, t};
  }
}

void Extremes::note(double t, const double* row) {
  columns_.evaluate(&t, row, 1);
  for (std::size_t i = 0; i < size(); ++i) take(i, signs_[i] * columns_[i][0], t);
}

void Extremes::note(const model::Sample& sample) {
  columns_.evaluate(sample);
  for (std::size_t i = 0; i < size(); ++i) take(i, signs_[i] * columns_[i][0], sample.t);
}

// Evaluates the open columns at all points, or with a stride of 2 at each second one: the others
// have the values of half as many points.
void Extremes::sample(const solve::Piece& piece, const ChebyshevPoints& points,
                      std::size_t stride) {
  const std::size_t count = points.size(), before = (count + 1) / 2, first = stride - 1;
  times_.clear();
  for (std::size_t p = first; p < count; p += stride) times_.push_back(time_of(piece, points, p));
  columns_.evaluate(piece, times_.data(), times_.size(), open_);
  values_.resize(count * size());
  for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
    const std::size_t i = *open;
    double* const values = &values_[i * count];
    for (std::size_t p = before; stride == 2 && p-- > 0;) values[2 * p] = values_[i * before + p];
    for (std::size_t k = 0; k < times_.size(); ++k) {
      values[first + k * stride] = signs_[i] * columns_[i][k];
    }
  }
}

bool Extremes::may_matter(std::size_t i, const ChebyshevPoints& points) const {
  const std::size_t count = points.size();
  const double* const values = &values_[i * count];
  double least = values[0], most = values[0];
  for (std::size_t p = 1; p < count; ++p) {
    least = std::min(least, values[p]);
    most = std::max(most, values[p]);
  }
  // Also true if a value is NaN.
  return !(most + points.overshoot() * (most - least) <= greatest_[i].value);
}

// More points would not resolve an overflow or a NaN either.
bool Extremes::is_shown(std::size_t i, const ChebyshevPoints& points) const {
  const double* const values = &values_[i * points.size()];
  const auto [least, most] = std::minmax_element(values, values + points.size());
  return !(points.tail(values) > shown * (*most - *least) + rounding * std::abs(*most));
}

void Extremes::climb_within(std::size_t i, const solve::Piece& piece,
                            const ChebyshevPoints& points) {
  const double* const values = &values_[i * points.size()];
  const double length = piece.to() - piece.from();
  for (std::size_t p = 0; p < points.size(); ++p) take(i, values[p], time_of(piece, points, p));
  const auto value_at = [&](double s) {
    const double t = std::min(piece.from() + length * s, piece.to());
    columns_.evaluate(piece, &t, 1, std::span(&i, 1));
    return signs_[i] * columns_[i][0];
  };
  const auto climb_there = [&](Bracket bracket) {
    // Refined values are those of the polynomial, and only as good as `shown`.
    for (Peak* const peak : {&bracket.from, &bracket.best, &bracket.to}) {
      peak->value = value_at(peak->at);
    }
    const Peak peak = climb(bracket, good_place * (bracket.to.at - bracket.from.at), value_at);
    take(i, peak.value, piece.from() + length * peak.at);
  };
  const double& greatest = greatest_[i].value;
  if (is_shown(i, points)) {
    refine(points, values, greatest, finer_);
    for_each_bracket(tables_.points(2 * (points.size() - 1)), finer_.data(), greatest,
                     Between::smooth, climb_there);
  } else {
    for_each_bracket(points, values, greatest, Between::kinks, climb_there);
  }
}

bool Extremes::may_exceed(std::size_t i, const solve::Bounds& bounds) const {
  return !(std::max(signs_[i] * bounds.least, signs_[i] * bounds.most) <= greatest_[i].value);
}

// Bounds of a column over a piece; infinite if only rows can show its range.
solve::Bounds Extremes::bounds_of(std::size_t i, const solve::Piece& piece, bool closely) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto known = bounded_[i] ? piece.bounds(*bounded_[i], *constants_, closely) : std::nullopt;
  return known.value_or(solve::Bounds{-infinity, infinity});
}

// Finds the columns whose bounds over the piece, which need no rows, do not exclude a value greater
// than the greatest so far. Takes the values of those that rise or fall all the way.
void Extremes::find_open(const solve::Piece& piece) {
  open_.clear();
  // The greatest and the least value of one column are neighbors and share the bounds.
  solve::Bounds bounds{};
  bool close = false;
  for (std::size_t i = 0; i < size(); ++i) {
    if (i == 0 || bounded_[i] != bounded_[i - 1]) {
      bounds = bounds_of(i, piece, false);
      close = false;
    }
    if (!may_exceed(i, bounds)) continue;
    if (!close) bounds = bounds_of(i, piece, true);
    close = true;
    if (!may_exceed(i, bounds)) continue;
    if (bounds.trend == 0) {
      open_.push_back(i);
    } else {
      const double t = signs_[i] * bounds.trend > 0 ? piece.to() : piece.from();
      columns_.evaluate(piece, &t, 1, std::span(&i, 1));
      take(i, signs_[i] * columns_[i][0], t);
    }
  }
}

// A piece counts if a value exceeds the greatest one so far, or if there is none yet.
bool Extremes::may_miss(solve::BoundsOfColumns& within) const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!bounded_[i]) return false;
    solve::Bounds& bounds = within[static_cast<std::size_t>(*bounded_[i])];
    const bool none = std::isnan(greatest_[i].value);
    const double most = none ? -std::numeric_limits<double>::infinity() : greatest_[i].value;
    if (signs_[i] > 0) {
      bounds.most = std::min(bounds.most, most);
    } else {
      bounds.least = std::max(bounds.least, -most);
    }
  }
  return true;
}

void Extremes::accept(const solve::Piece& piece) {
  find_open(piece);
  if (open_.empty()) return;
  // Half of the points that may be needed usually resolve all columns.
  const std::size_t enough = piece.parts();
  std::size_t parts = std::max(fewest_parts, (enough + 1) / 2);
  for (std::size_t stride = 1;; parts *= 2, stride = 2) {
    const ChebyshevPoints& points = tables_.points(parts);
    sample(piece, points, stride);
    const bool few = parts < enough;
    bool all_shown = true;
    matter_.clear();
    for (const std::size_t i : open_) {
      const bool matters = may_matter(i, points);
      if (matters) matter_.push_back(i);
      if (matters || few) all_shown = all_shown && is_shown(i, points);
    }
    if (all_shown || (!few && 2 * parts > most_parts)) break;
  }
  for (const std::size_t i : matter_) climb_within(i, piece, tables_.points(parts));
}

}  // namespace bbsim::record
