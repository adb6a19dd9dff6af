// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Bounds of columns over a piece, from ranges of smooth quantities at its nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/real.hpp"
#include "solve/piece.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

// The range of a smooth quantity over the whole piece, from its range at the nodes.
[[nodiscard]] inline Range widened(const Range& at_nodes) {
  const double beyond = overshoot * (at_nodes.most - at_nodes.least);
  return {at_nodes.least - beyond, at_nodes.most + beyond};
}
// The same from its range at the Chebyshev points.
[[nodiscard]] inline Range widened_closely(const Range& at_points) {
  const double beyond = close_overshoot * (at_points.most - at_points.least);
  return {at_points.least - beyond, at_points.most + beyond, at_points.trend};
}

// Of the cosine of the tilt.
inline constexpr double up_rounding = 4 * std::numeric_limits<double>::epsilon();

// range_of(quantity) is the range over the piece.
template <class RangeOf>
[[nodiscard]] std::optional<Bounds> column_bounds(Bounded column, RangeOf range_of) {
  const auto same = [&](Quantity quantity) {
    const Range of = range_of(quantity);
    return Bounds{of.least, of.most, of.trend};
  };
  const auto root = [&](Quantity squared) {
    const Range of = range_of(squared);
    return Bounds{std::sqrt(std::max(of.least, 0.0)), std::sqrt(std::max(of.most, 0.0)), of.trend};
  };
  switch (column) {
    case Bounded::x:
      return same(Quantity::x);
    case Bounded::y:
      return same(Quantity::y);
    case Bounded::vx:
      return same(Quantity::vx);
    case Bounded::vy:
      return same(Quantity::vy);
    case Bounded::distance:
      return root(Quantity::distance_squared);
    case Bounded::tracking_error:
      return root(Quantity::error_squared);
    case Bounded::tilt_rate:
      return root(Quantity::rate_squared);
    case Bounded::tilt: {
      const Range up = range_of(Quantity::up);
      const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
      return Bounds{angle(up.most + up_rounding), angle(up.least - up_rounding), -up.trend};
    }
    case Bounded::motor_torque_phi:
      return same(Quantity::torque_phi);
    case Bounded::motor_torque_theta:
      return same(Quantity::torque_theta);
    case Bounded::motor_power:
      return same(Quantity::power);
  }
  return {};
}

// Whether a load of a motor has a bound.
[[nodiscard]] inline bool bounds_loads(const BoundsOfColumns& within) {
  for (const Bounded load :
       {Bounded::motor_torque_phi, Bounded::motor_torque_theta, Bounded::motor_power}) {
    const Bounds& of = within[static_cast<std::size_t>(load)];
    if (of.least > -infinity || of.most < infinity) return true;
  }
  return false;
}

// The reverse: calls use(quantity, least, most) with the range of each quantity in which no column
// leaves its bounds. Rounding narrows it. Motors' loads are left out.
template <class Use>
void for_each_bound(const BoundsOfColumns& within, Use use) {
  const auto of = [&](Bounded column) { return within[static_cast<std::size_t>(column)]; };
  const auto same = [&](Bounded column, Quantity quantity) {
    use(quantity, of(column).least, of(column).most);
  };
  const auto square = [&](Bounded column, Quantity squared) {
    const auto signed_square = [](double value) { return value * std::abs(value); };
    use(squared, signed_square(of(column).least), signed_square(of(column).most));
  };
  same(Bounded::x, Quantity::x);
  same(Bounded::y, Quantity::y);
  same(Bounded::vx, Quantity::vx);
  same(Bounded::vy, Quantity::vy);
  square(Bounded::distance, Quantity::distance_squared);
  square(Bounded::tracking_error, Quantity::error_squared);
  square(Bounded::tilt_rate, Quantity::rate_squared);
  const double least = of(Bounded::tilt).least, most = of(Bounded::tilt).most;
  use(Quantity::up, most < std::numbers::pi ? std::cos(std::max(most, 0.0)) + up_rounding : -most,
      least >= 0 ? std::cos(std::min(least, std::numbers::pi)) - up_rounding : -least);
}

}  // namespace bbsim::solve::sampled
