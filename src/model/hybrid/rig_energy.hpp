// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The energy of a rig whose servos determine the plate's motion. Without losses its changes are the
// servos' work.
#pragma once

#include <type_traits>
#include <variant>

#include "model/ball/dynamics.hpp"
#include "model/systems/list.hpp"

namespace bbsim::model {

// The energy of a rolling ball and of the bodies that turn with the plane, (M51), J.
[[nodiscard]] inline double energy_of(const CoupledBall& ball, const double* z,
                                      const RigExtras& plane) {
  const BallConstants constants{ball.r, ball.m, ball.g, false, ball.rolling, ball.body};
  Sample sample;
  sample.ball = ball_motion<Shape::full>(RigLayout::unpack(z), ball.r);
  sample.gimbal = {plane.angle[0], plane.angle[1], plane.rate[0], plane.rate[1], 0, 0};
  const Dynamics now = dynamics(sample, constants);
  return now.energy() + now.gimbal_energy;
}

// The same of a coupled loop in states z and its present mode; 0 of other systems.
[[nodiscard]] inline double rig_energy(const System& system, const double* z) {
  return std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any>) {
          return energy_of(any.parts.ball, z, any.loop.plane(z));
        } else {
          return 0.0;
        }
      },
      system);
}

}  // namespace bbsim::model
