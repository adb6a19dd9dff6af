// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The arithmetic of a sampled controller, for every number type: a pack of doubles holds one rig
// per lane.
#pragma once

#include <array>
#include <cstddef>

#include "base/real.hpp"
#include "model/control/law.hpp"

namespace bbsim::model {

// Constants of a run.
template <class Scalar>
struct SampledLaw {
  struct Interval {
    Scalar low, high;
  };

  BasicControlLaw<Scalar> law;
  bool integrates = false;  // law.integrates()
  Interval limit[2];        // of the command of phi and of theta, rad, or rad/s^2
  Interval sine[2];         // of the limit, for gravity compensation
  Scalar resolution;        // of the command; 0: none
  Interval reached[2];      // by multiples of the resolution within the limit
  Scalar filter;            // time constant of the velocity filter, s
};

// Memory from sample to sample: the ball's measured position (m), its velocity, and the integral
// parts of the commands.
template <class Real>
struct SampledMemory {
  Real position[2], velocity[2], integral[2];
};

// Time since the controller last saw the ball.
struct SinceSeen {
  bool any = false;  // whether it ever did
  int unseen = 0;    // samples missed since then

  // From that sample to the present one, s; one period at the first sample.
  [[nodiscard]] double elapsed(double period) const { return (any ? 1 + unseen : 1) * period; }
  void miss() { ++unseen; }
  void see() { *this = {true, 0}; }
};

template <class Real>
[[nodiscard]] Real clamped(const Real& value, const Real& low, const Real& high) {
  return choose(exceeds(low, value), low, choose(exceeds(value, high), high, value));
}

// The nearest multiple of the resolution; the value itself if the resolution is 0.
template <class Real>
[[nodiscard]] Real in_steps(const Real& value, const Real& resolution) {
  const auto steps = exceeds(resolution, Real(0.0));
  const Real step = choose(steps, resolution, Real(1.0));
  return choose(steps, nearest_integer(value / step) * step, value);
}

// Limits a command and rounds it: to the nearest multiple of the resolution, or to the last
// multiple within the limit.
template <class Real>
void keep_within_limits(const SampledLaw<Real>& of, Real (&command)[2]) {
  const auto steps = exceeds(of.resolution, Real(0.0));
  for (int i = 0; i < 2; ++i) {
    command[i] = clamped(command[i], of.limit[i].low, of.limit[i].high);
    const Real reached = clamped(command[i], of.reached[i].low, of.reached[i].high);
    command[i] = choose(steps, in_steps(reached, of.resolution), command[i]);
  }
}

// Processes a sample that saw the ball at `seen`, `elapsed` (s) after the last one that did;
// `first`: there was none. `servo` holds the servos' angles (rad) and rates (rad/s), for laws that
// feed them back. Conditional integration: a command's integral part waits if the command, before
// this sample's error is added to it, is at its limit and the error drives it outward.
template <class Real, class Mask>
void take_sample(const SampledLaw<Real>& of, SampledMemory<Real>& memory, const Real (&seen)[2],
                 const Real& elapsed, const Mask& first, const Real (&servo)[4],
                 const std::array<Jet<Real>, 2>& reference, Real (&commanded)[2]) {
  const Real keep = of.filter / (of.filter + elapsed);
  for (int i = 0; i < 2; ++i) {
    const Real difference = choose(first, Real(0.0), (seen[i] - memory.position[i]) / elapsed);
    memory.velocity[i] = keep * memory.velocity[i] + (Real(1.0) - keep) * difference;
    memory.position[i] = seen[i];
  }
  const bool of_sine = of.law.kind == LawKind::gravity_compensation;
  const auto output = [&] {
    const Feedback<Real> state{{memory.position[0], memory.position[1]},
                               {memory.velocity[0], memory.velocity[1]},
                               {servo[0], servo[1]},
                               {servo[2], servo[3]},
                               {memory.integral[0], memory.integral[1]}};
    return command(of.law, state, reference, [&](int i, const Real& raw) {
      return of_sine ? clamped(raw, of.sine[i].low, of.sine[i].high) : raw;
    });
  };
  Command<Real> u = output();
  if (of.integrates) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Real rate = integral_rate(of.law, i, memory.position, reference);
      const Real upward = choose(exceeds(of.limit[i].high, u.value[i]), rate, Real(0.0));
      const Real downward = choose(exceeds(u.value[i], of.limit[i].low), rate, Real(0.0));
      memory.integral[i] += elapsed * choose(exceeds(rate, Real(0.0)), upward, downward);
    }
    u = output();
  }
  for (int i = 0; i < 2; ++i) commanded[i] = u.value[i];
  keep_within_limits(of, commanded);
}

}  // namespace bbsim::model
