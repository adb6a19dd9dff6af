// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/servo/servo.hpp"

#include <vector>

#include "base/number_text.hpp"
#include "base/text.hpp"

namespace bbsim::model {

ServoResponse response_of(const Servo& servo, const Controller& controller) {
  if (servo.stepper) {
    // A stepper's ramp is no linear response. Linear analysis takes it for one that is over within
    // a small part of a period, but for the shaft's swings.
    constexpr double ramp_frequency = 100;  // times the period
    const StepperMotor& motor = *servo.stepper;
    const double w = motor.natural_frequency.value_or(ramp_frequency / controller.sampling->period);
    return {w * w, w * w, 2 * (motor.natural_frequency ? motor.damping : 1) * w};
  }
  if (servo.time_constant) return {0, 0, 1 / *servo.time_constant};
  const double w = servo.natural_frequency;
  return {w * w, w * w, 2 * servo.damping * w};
}

RigServo rig_servo(const Servo& servo, const Controller& controller) {
  RigServo rig{servo};
  if (servo.stepper) {
    const StepperMotor& motor = *servo.stepper;
    rig.step = motor.microstep();
    if (motor.torque) rig.torque_limit = *motor.torque / (*motor.inertia * motor.gear);
    if (motor.corner_speed) rig.corner_rate = *motor.corner_speed / motor.gear;
    rig.field_period = 4 * motor.microsteps * rig.step;
    rig.rings = motor.natural_frequency.has_value();
    if (controller.is_sketch()) rig.pulse_time = controller.sampling->period;
  }
  return rig;
}

std::string kind_of(const Servo& servo) {
  if (servo.stepper) return "stepper";
  return servo.time_constant ? "first-order servo" : "second-order servo";
}

std::string limits_of(const Servo& servo) {
  std::vector<std::string> parts;
  const auto add = [&](bool holds, const std::string& part) {
    if (holds) parts.push_back(part);
  };
  if (servo.stepper) {
    const StepperMotor& motor = *servo.stepper;
    parts.push_back("microsteps of " + degrees(motor.microstep()));
    if (motor.torque) {
      parts.push_back("loses steps beyond " +
                      short_number(*motor.torque / (*motor.inertia * motor.gear)) + " rad/s^2");
    }
    if (motor.natural_frequency) {
      parts.push_back("rings at " + short_number(*motor.natural_frequency) + " rad/s, damping " +
                      short_number(motor.damping));
    }
  }
  add(servo.angle_limit < unlimited, "stops at " + degrees(servo.angle_limit));
  add(servo.rate_limit < unlimited, "at most " + degrees(servo.rate_limit) + "/s");
  add(servo.acceleration_limit < unlimited,
      "at most " + short_number(servo.acceleration_limit) + " rad/s^2");
  add(servo.dead_band > 0, "dead band " + degrees(servo.dead_band));
  add(servo.backlash > 0, "backlash " + degrees(servo.backlash));
  return joined(parts);
}

std::string servo_note(const Servo& servo) {
  const std::string speed = servo.stepper ? "stepper"
                            : servo.time_constant
                                ? "time constant " + milliseconds(*servo.time_constant)
                                : "natural frequency " + short_number(servo.natural_frequency) +
                                      " rad/s, damping " + short_number(servo.damping);
  const std::string limits = limits_of(servo);
  return speed + (limits.empty() ? "" : ", " + limits);
}

}  // namespace bbsim::model
