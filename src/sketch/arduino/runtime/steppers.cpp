// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Stepper motors behind drivers with inputs for step and direction, such as the A4988. Pulses count
// from where the shaft stands as the board is switched on.
#include <math.h>

#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

constexpr int motors = 3;
struct Motor {
  bool step_is_high;
  long long count;  // pulses forward less those back
} shafts[motors];

const bbsim_wired_stepper& wired(int motor) {
  return board.wiring.steppers[motor];
}

double turned(int motor) {
  return wired(motor).angle * static_cast<double>(shafts[motor].count);  // rad
}

}  // namespace

bool has_steppers() {
  for (int i = 0; i < motors; ++i) {
    if (wired(i).step >= 0) return true;
  }
  return false;
}

void step_motor(int pin, bool high) {
  for (int i = 0; i < motors; ++i) {
    const bbsim_wired_stepper& motor = wired(i);
    if (motor.step < 0 || motor.step != pin) continue;
    const bool rises = high && !shafts[i].step_is_high;
    shafts[i].step_is_high = high;
    const bool disabled = motor.enable >= 0 && drive_of(motor.enable) == Drive::high;
    if (rises && !disabled) shafts[i].count += drive_of(motor.dir) == Drive::high ? 1 : -1;
  }
}

bool limit_switch_reads(int pin, double& level) {
  for (int i = 0; i < motors; ++i) {
    const bbsim_wired_stepper& motor = wired(i);
    if (motor.home < 0 || motor.home != pin) continue;
    const double from_start = turned(i), to_switch = motor.home_angle - motor.start;
    const bool closed = to_switch > 0 ? from_start >= to_switch : from_start <= to_switch;
    level = closed ? motor.home_level : 1 - motor.home_level;
    return true;
  }
  return false;
}

bool is_of_stepper(int pin) {
  for (int i = 0; i < motors; ++i) {
    const bbsim_wired_stepper& motor = wired(i);
    if (motor.step >= 0 && (motor.step == pin || motor.dir == pin || motor.enable == pin)) {
      return true;
    }
  }
  return false;
}

// The start of each motor becomes known at t = 0: pulses of setup() have brought it to where the
// scenario's run begins.
void place_steppers() {
  if (!has_steppers()) return;
  const double angle[] = {board.sample.servo[0], board.sample.servo[1], board.sample.third_servo};
  for (int i = 0; i < motors; ++i) {
    double& start = board.wiring.steppers[i].start;
    if (isnan(start)) start = angle[i] - turned(i);
  }
}

void command_steppers() {
  if (!has_steppers()) return;
  for (int i = 0; i < motors; ++i) board.command[i] = wired(i).start + turned(i);
}

}  // namespace bbsim_board
