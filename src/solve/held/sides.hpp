// Whether a monitor stays on its side over a whole piece, by the ranges of what it watches.
#pragma once

#include <cmath>

#include "model/events/event_monitors.hpp"
#include "solve/held/kernel.hpp"

namespace bbsim::solve::held {

// What a smooth number takes at most, and at least.
[[nodiscard]] inline Range widened(const Range& at_nodes) {
  const double beyond = overshoot * (at_nodes.most - at_nodes.least);
  return {at_nodes.least - beyond, at_nodes.most + beyond};
}

// Whether the numbers are all above the limit, or, if `below`, all below.
[[nodiscard]] inline bool beyond(const Range& range, double limit, bool below) {
  return below ? range.most < limit : range.least > limit;
}

// `range(Look)` is the range at the start and the nodes. If it cannot be told, the answer is no.
template <class RangeOf>
[[nodiscard]] bool keeps_its_side(const model::Monitor& monitor, const Plate& plate, bool happening,
                                  RangeOf range) {
  using Kind = model::Monitor::Kind;
  switch (monitor.kind) {
    case Kind::edge: {
      bool within = true, off = false;
      const auto look = [&](const Range& of, double least, double most) {
        within = within && of.least > least && of.most < most;
        off = off || of.least > most || of.most < least;
      };
      if (plate.size) {
        for (int i = 0; i < 2; ++i) {
          const double most = (*plate.size)[static_cast<std::size_t>(i)] / 2;
          look(widened(range(i == 0 ? Look::x : Look::y)), -most, most);
        }
      }
      if (plate.diameter) {
        const double most = *plate.diameter * *plate.diameter / 4;
        look(widened(range(Look::distance_squared)), -most, most);
      }
      return happening ? off : within;
    }
    case Kind::slip:
      // Where nothing presses, the square says nothing.
      return beyond(widened(range(Look::grip)), 0, happening) &&
             beyond(widened(range(Look::normal)), 0, false);
    case Kind::lift_off:
      return beyond(widened(range(Look::normal)), 0, happening);
    case Kind::tilt:
      return beyond(widened(range(Look::up)), std::cos(monitor.limit), happening);
    case Kind::singularity:
    case Kind::dead_point:
      break;
  }
  return false;
}

}  // namespace bbsim::solve::held
