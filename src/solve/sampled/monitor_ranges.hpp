// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks from ranges whether a monitor stays on its side over a whole piece.
#pragma once

#include <cmath>

#include "model/events/event_monitors.hpp"
#include "solve/sampled/column_bounds.hpp"

namespace bbsim::solve::sampled {

// Calls use(Quantity, least, most) for each quantity of a monitor, with the range in which nothing
// happens. Returns false if these quantities cannot decide this monitor.
template <class Use>
[[nodiscard]] bool for_each_range(const model::Monitor& monitor, const Plate& plate, Use use) {
  using Kind = model::Monitor::Kind;
  switch (monitor.kind) {
    case Kind::edge:
      if (plate.size) {
        const double x = (*plate.size)[0] / 2, y = (*plate.size)[1] / 2;
        use(Quantity::x, -x, x);
        use(Quantity::y, -y, y);
      }
      if (plate.diameter) {
        const double most = *plate.diameter * *plate.diameter / 4;
        use(Quantity::distance_squared, -most, most);
      }
      return true;
    case Kind::slip:
      // The squared grip says nothing without a contact force, so the force must be positive too.
      use(Quantity::grip, 0, unlimited);
      use(Quantity::normal, 0, unlimited);
      return true;
    case Kind::lift_off:
      use(Quantity::normal, 0, unlimited);
      return true;
    case Kind::tilt:
      use(Quantity::up, std::cos(monitor.limit), unlimited);
      return true;
    case Kind::singularity:
    case Kind::dead_point:
      break;
  }
  return false;
}

// Returns false if ranges cannot decide. range(quantity) is the range at the start and the nodes.
template <class RangeOf>
[[nodiscard]] bool stays_in_range(const model::Monitor& monitor, const Plate& plate, bool occurring,
                                  RangeOf range) {
  bool within = true, beyond = false, presses = true;
  const bool decidable =
      for_each_range(monitor, plate, [&](Quantity quantity, double least, double most) {
        const Range of = widened(range(quantity));
        within = within && of.least > least && of.most < most;
        if (occurring && quantity == Quantity::normal &&
            monitor.kind == model::Monitor::Kind::slip) {
          presses = of.least > least;
        } else {
          beyond = beyond || of.most < least || of.least > most;
        }
      });
  return decidable && (occurring ? beyond && presses : within);
}

}  // namespace bbsim::solve::sampled
