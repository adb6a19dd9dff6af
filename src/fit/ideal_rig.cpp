// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/ideal_rig.hpp"

namespace bbsim::fit {

std::optional<Scenario> ideal_rig(const Scenario& scenario) {
  Scenario ideal = scenario;
  if (const auto* const commands = commands_of(scenario)) {
    ideal.gimbal.motion = GimbalMotion{commands->phi, commands->theta};
    ideal.controller.reset();
  }
  if (!ideal.gimbal.motion) return {};
  ideal.gimbal.servo.reset();
  ideal.gimbal.theta_servo.reset();
  ideal.gimbal.linkage = {};
  ideal.gimbal.three_servos.reset();
  ideal.gimbal.mounting = {};
  if (!ideal.ball.groove) ideal.ball.inertia_factor = Ball{}.inertia_factor;
  ideal.ball.losses = {};
  ideal.ball.rotation.reset();
  ideal.events = {};
  return ideal;
}

}  // namespace bbsim::fit
