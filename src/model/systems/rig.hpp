// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a built rig has beside the right-hand side: what switches and what samples.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/servo/linkages.hpp"
#include "model/systems/rig_loop.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

class ExternalController;

// A controller in discrete time and its sensor.
struct SampledLoop {
  Sampling sampling;
  Sensor sensor;
  ControlLaw law;  // what is computed at each sample; held, if that is not for the model to know
  CommandRange limit[2];  // phi, theta: of what the law says
  Between between;        // what makes servos' commands of that
  // Under a held law: who is asked instead (control/external_controller.hpp), which whoever runs
  // the model has to see to; and the names of the numbers that it gives for columns.
  std::shared_ptr<ExternalController> external{};
  std::vector<std::string> own_columns{};
};

// How a servo differs from an ideal one.
struct RigServo {
  double angle_limit = unlimited;         // rad
  double rate_limit = unlimited;          // rad/s
  double acceleration_limit = unlimited;  // rad/s^2
  double dead_band = 0, backlash = 0;     // rad
  std::optional<double> time_constant;    // of a servo of first order, s
  double offset = 0;                      // angle of the plane at the servo's zero, rad

  [[nodiscard]] bool switches() const {
    return angle_limit < unlimited || rate_limit < unlimited || acceleration_limit < unlimited ||
           backlash > 0;
  }
};

// How the servos and the controller of a closed loop that is a RigLoop differ from ideal ones.
struct Rig {
  int servos = 2;  // phi's, theta's; or three
  RigServo servo[most_servos];
  // A continuous law's command is kept within it; in gravity compensation, the command's sine.
  CommandRange command_limit[2];
  Between between;
  std::optional<SampledLoop> sampled;

  [[nodiscard]] bool limits_commands() const {
    return command_limit[0].binds() || command_limit[1].binds();
  }
  [[nodiscard]] bool switches() const {
    bool any = limits_commands() || between.has_pieces();
    for (const RigServo& one : servo) any = any || one.switches();
    return any;
  }
};

}  // namespace bbsim::model
