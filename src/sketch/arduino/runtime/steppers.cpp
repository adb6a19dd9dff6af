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
    const double off = start + turned(i) - angle[i];
    if (fabs(off) > TWO_PI / 360) {
      static const char* const names[] = {"phi", "theta", "1", "2", "3"};
      const char* const name = names[board.wiring.steppers[2].step >= 0 ? 2 + i : i];
      say_why(
          "the motor %s stands at %.4g deg at t = 0, after setup(), where the run begins with its "
          "servo at %.4g deg; allowed: steppers.%s.start and home that bring it there, to 1 deg",
          name, 360 / TWO_PI * (angle[i] + off), 360 / TWO_PI * angle[i], name);
      board.misfit = true;
    }
  }
}

void describe_steppers(char* text, size_t size) {
  if (!has_steppers()) return;
  const int count = wired(2).step >= 0 ? 3 : 2;
  size_t used = 0;
  for (int i = 0; i < count; ++i) {
    const int wrote = snprintf(text + used, size - used, "%s%.4g deg",
                               i == 0          ? "; the shafts have turned by "
                               : i + 1 < count ? ", "
                                               : " and ",
                               360 / TWO_PI * turned(i));
    used += wrote > 0 && static_cast<size_t>(wrote) < size - used ? static_cast<size_t>(wrote) : 0;
  }
}

void command_steppers() {
  if (!has_steppers()) return;
  for (int i = 0; i < motors; ++i) board.command[i] = wired(i).start + turned(i);
}

}  // namespace bbsim_board
