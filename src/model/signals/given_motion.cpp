// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/signals/given_motion.hpp"

namespace bbsim::model {

SignalPair given_motion(const Scenario& scenario) {
  const Gimbal& gimbal = scenario.gimbal;
  SignalPair motion;
  motion.add(0, gimbal.motion->phi);
  motion.add(1, gimbal.motion->theta);
  motion.add_constant(0, gimbal.mounting.phi_offset);
  motion.add_constant(1, gimbal.mounting.theta_offset);
  return motion;
}

}  // namespace bbsim::model
