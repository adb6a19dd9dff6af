// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The data of a rig that its right-hand side does not hold: switches and sampling.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/ball/dynamics.hpp"
#include "model/servo/linkages.hpp"
#include "model/servo/servo.hpp"
#include "model/systems/rig_loop.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

class ExternalController;

// A sampled controller and its sensor.
struct SampledLoop {
  Sampling sampling;
  Sensor sensor;
  ControlLaw law;         // computed at each sample; `held` for an external controller
  CommandRange limit[2];  // phi, theta: limits of the law's commands
  Mechanism mechanism;    // converts commands for the servos
  std::optional<BallConstants> pressing{};  // what presses on a touch screen, if that matters
  bool legs = false;  // commands are angles of three servos and need no conversion
  // For a held law: the external controller (control/external_controller.hpp), which the caller
  // must attach before a run, and the names of the columns that it returns.
  std::shared_ptr<ExternalController> external{};
  std::vector<std::string> own_columns{};
};

// The deviations of the servos and the controller of a closed loop from ideal ones.
struct Rig {
  int servos = 2;  // for phi and theta, or three
  RigServo servo[most_servos];
  // Limits of a continuous law's command; for gravity compensation, of the command's sine.
  CommandRange command_limit[2];
  Mechanism mechanism;
  std::optional<SampledLoop> sampled;
  OnEvent steps_lost = OnEvent::note;

  [[nodiscard]] bool rings() const { return std::ranges::any_of(servo, &RigServo::rings); }
  [[nodiscard]] bool limits_commands() const {
    return command_limit[0].binds() || command_limit[1].binds();
  }
  [[nodiscard]] bool switches() const {
    return limits_commands() || mechanism.has_pieces() ||
           std::ranges::any_of(servo, &RigServo::switches);
  }
};

}  // namespace bbsim::model
