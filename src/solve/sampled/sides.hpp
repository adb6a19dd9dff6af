// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Whether a monitor stays on its side over a whole piece, by the ranges of what it watches.
#pragma once

#include <cmath>

#include "model/events/event_monitors.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

// What a smooth number takes at most, and at least.
[[nodiscard]] inline Range widened(const Range& at_nodes) {
  const double beyond = overshoot * (at_nodes.most - at_nodes.least);
  return {at_nodes.least - beyond, at_nodes.most + beyond};
}

// What a monitor for which nothing happens is told by: use(Look, least, most), for each thing that
// is looked at, says between which numbers it has to stay. Returns false for one that is not told
// by such things.
template <class Use>
[[nodiscard]] bool for_each_side(const model::Monitor& monitor, const Plate& plate, Use use) {
  constexpr double unlimited = model::unlimited;
  using Kind = model::Monitor::Kind;
  switch (monitor.kind) {
    case Kind::edge:
      if (plate.size) {
        const double x = (*plate.size)[0] / 2, y = (*plate.size)[1] / 2;
        use(Look::x, -x, x);
        use(Look::y, -y, y);
      }
      if (plate.diameter) {
        const double most = *plate.diameter * *plate.diameter / 4;
        use(Look::distance_squared, -most, most);
      }
      return true;
    case Kind::slip:
      // Where nothing presses, the square says nothing.
      use(Look::grip, 0, unlimited);
      use(Look::normal, 0, unlimited);
      return true;
    case Kind::lift_off:
      use(Look::normal, 0, unlimited);
      return true;
    case Kind::tilt:
      use(Look::up, std::cos(monitor.limit), unlimited);
      return true;
    case Kind::singularity:
    case Kind::dead_point:
      break;
  }
  return false;
}

// `range(Look)` is the range at the start and the nodes. If it cannot be told, the answer is no.
template <class RangeOf>
[[nodiscard]] bool keeps_its_side(const model::Monitor& monitor, const Plate& plate, bool happening,
                                  RangeOf range) {
  bool within = true, beyond = false, presses = true;
  const bool told = for_each_side(monitor, plate, [&](Look look, double least, double most) {
    const Range of = widened(range(look));
    within = within && of.least > least && of.most < most;
    if (happening && look == Look::normal && monitor.kind == model::Monitor::Kind::slip) {
      presses = of.least > least;
    } else {
      beyond = beyond || of.most < least || of.least > most;
    }
  });
  return told && (happening ? beyond && presses : within);
}

}  // namespace bbsim::solve::sampled
