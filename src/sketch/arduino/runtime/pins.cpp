// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Pins: their modes and levels, as on an AVR, and the parts that are wired to them.
#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

struct Pin {
  bool output;
  bool high;  // for an input: its pull-up is on
} state[pins];

int analog_bits = 10;

int checked(int pin, const char* function) {
  if (pin >= 0 && pin < pins) return pin;
  fail("%s(%d): there is no such pin; allowed: 0 to 53 and A0 to A15", function, pin);
  return 0;
}

// The level of a pin, 0 to 1: its own output, or that of the part that is wired to it.
double level_of(int pin, const char* function) {
  double level = 0;
  if (state[pin].output) return state[pin].high ? 1 : 0;
  if (screen_reads(pin, level)) return level;
  for (size_t i = 0; i < board.wiring.input_count; ++i) {
    const bbsim_wired_input& input = board.wiring.inputs[i];
    if (input.pin == pin) return pin < first_analog ? input.value : input.value / 1023;
  }
  if (state[pin].high) return 1;  // nothing pulls it down
  fail(
      "%s(%s): nothing is wired to pin %s; set a constant in the wiring: "
      "inputs: {%s: %s}",
      function, pin_name(pin), pin_name(pin), pin_name(pin), pin < first_analog ? "0" : "512");
  return 0;
}

}  // namespace

Drive drive_of(int pin) {
  if (pin < 0) return Drive::none;
  const Pin& one = state[pin];
  if (one.output) return one.high ? Drive::high : Drive::low;
  return one.high ? Drive::pull_up : Drive::none;
}

const char* pin_name(int pin) {
  static char name[16];
  snprintf(name, sizeof name, pin < first_analog ? "%d" : "A%d",
           pin < first_analog ? pin : pin - first_analog);
  return name;
}

}  // namespace bbsim_board

using namespace bbsim_board;

void pinMode(int number, int mode) {
  Pin& pin = state[checked(number, "pinMode")];
  pin.output = mode == OUTPUT;
  if (mode == INPUT) pin.high = false;
  if (mode == INPUT_PULLUP) pin.high = true;
  spend(board.costs.digital);
}

void digitalWrite(int number, int level) {
  state[checked(number, "digitalWrite")].high = level != LOW;
  spend(board.costs.digital);
}

int digitalRead(int number) {
  const int read = level_of(checked(number, "digitalRead"), "digitalRead") > 0.5 ? HIGH : LOW;
  spend(board.costs.digital);
  return read;
}

int analogRead(int number) {
  if (number >= 0 && number < 16) number += first_analog;  // a channel number
  if (checked(number, "analogRead") < first_analog) {
    fail("analogRead(%d): pin %d is not analog; allowed: A0 to A15", number, number);
  }
  const double most = static_cast<double>((1L << analog_bits) - 1);
  const double counts = level_of(number, "analogRead") * most;
  spend(board.costs.analog);  // the converter samples before it converts
  return static_cast<int>(lround(counts < 0 ? 0 : counts > most ? most : counts));
}

void analogReadResolution(int bits) {
  if (bits < 1 || bits > 16) fail("analogReadResolution(%d): allowed: 1 to 16 bits", bits);
  analog_bits = bits;
}

void analogReference(int) {}
void analogWriteResolution(int) {}

void analogWrite(int number, int) {
  const int pin = checked(number, "analogWrite");
  for (const bbsim_wired_servo& servo : board.wiring.servos) {
    if (servo.pin != pin) continue;
    fail("analogWrite(%d, ...): a servo is wired to pin %d, which needs the pulses of Servo.h", pin,
         pin);
  }
  state[pin].output = true;
  spend(board.costs.digital);
}
