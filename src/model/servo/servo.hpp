// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A servo of a scenario as the model has it: how it answers its command, its deviations from an
// ideal servo, and its words for `bbsim check`. What its limits and losses do is in servo_axis.hpp.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace bbsim::model {

// Servo acceleration in free motion: from_command u - from_angle q - from_rate q'.
struct ServoResponse {
  double from_command = 1, from_angle = 0, from_rate = 0;

  // A response that comes to rest at the same angle. A servo without stiffness sets its rate from
  // its command and rests at the command.
  [[nodiscard]] ServoResponse at_rest() const {
    return {from_angle > 0 ? from_command / from_angle : 1, 1, 0};
  }
};

[[nodiscard]] ServoResponse response_of(const Servo& servo, const Controller& controller);

// A servo with the numbers that follow from its keys, which the model reads in their place.
struct RigServo : Servo {
  double offset = 0;      // angle of the plane at the servo's zero, rad
  double step = 0;        // of a stepper: its microstep, rad; 0: not a stepper
  bool rings = false;     // a stepper whose shaft rings about its driver's field
  double pulse_time = 0;  // of a stepper under a sketch's pulses: it takes this to a target, s
  // The greatest acceleration that a stepper's torque gives its shaft, rad/s^2; the rate beyond
  // which it falls as 1/rate, rad/s; and the period of its field, four full steps, rad.
  double torque_limit = unlimited, corner_rate = unlimited, field_period = 0;

  [[nodiscard]] bool switches() const {
    return step > 0 || angle_limit < unlimited || rate_limit < unlimited ||
           acceleration_limit < unlimited || backlash > 0;
  }
};

[[nodiscard]] RigServo rig_servo(const Servo& servo, const Controller& controller);

// "second-order servo"
[[nodiscard]] std::string kind_of(const Servo& servo);
// "stops at 60 deg, backlash 0.3 deg"; empty if there are none.
[[nodiscard]] std::string limits_of(const Servo& servo);
// "natural frequency 30 rad/s, damping 0.8", and its limits.
[[nodiscard]] std::string servo_note(const Servo& servo);

}  // namespace bbsim::model
