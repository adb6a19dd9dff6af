// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Pins: their modes and levels, as on an AVR, and the parts that are wired to them.
#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

struct Pin {
  bool output;
  bool high;    // for an input: its pull-up is on
  bool driven;  // it was an output at HIGH, or had pulses
} state[pins];

int last_read = -1, last_level = LOW;  // by digitalRead()
int analog_bits = 10, first_bits = 0;  // at the first reading; 0: there was none

int checked(int pin, const char* function) {
  if (pin >= 0 && pin < pins) return pin;
  fail("%s(%d): there is no such pin; allowed: 0 to 53 and A0 to A15", function, pin);
  return 0;
}

// The level of a pin, 0 to 1: its own output, or that of the part that is wired to it.
double level_of(int pin, const char* function) {
  double level = 0;
  if (state[pin].output) return state[pin].high ? 1 : 0;
  if (screen_reads(pin, level) || distance_reads(pin, level) || limit_switch_reads(pin, level)) {
    return level;
  }
  for (size_t i = 0; i < board.wiring.input_count; ++i) {
    const bbsim_wired_input& input = board.wiring.inputs[i];
    if (input.pin == pin) return pin < first_analog ? input.value : input.value / full_scale();
  }
  if (state[pin].high) return 1;  // nothing pulls it down
  fail(
      "%s(%s): nothing is wired to pin %s; set a constant in the wiring: "
      "inputs: {%s: %s}",
      function, pin_name(pin), pin_name(pin), pin_name(pin), pin < first_analog ? "0" : "512");
  return 0;
}

// Ends the run if the wiring has counts beyond the converter's bits: all of them would read as the
// greatest one.
void require_counts(double counts, const char* key) {
  const double most = full_scale();
  if (counts <= most) return;
  board.misfit = true;
  fail(
      "%s: found %g counts, but the sketch reads %d bits; allowed: at most %g, or call "
      "analogReadResolution() before the first analogRead()",
      key, counts, first_bits, most);
}

void begin_reading() {
  if (first_bits != 0) return;
  first_bits = analog_bits;
  const bbsim_wiring& wiring = board.wiring;
  const bbsim_wired_screen& screen = wiring.screen;
  if (screen.kind == bbsim_four_wires || screen.kind == bbsim_five_wires ||
      screen.kind == bbsim_voltages) {
    for (int i = 0; i < 2; ++i) {
      require_counts(screen.x.counts[i], "screen.x.counts");
      require_counts(screen.y.counts[i], "screen.y.counts");
    }
    require_counts(screen.untouched, "screen.untouched");
  }
  for (size_t i = 0; i < wiring.input_count; ++i) {
    if (wiring.inputs[i].pin >= first_analog) require_counts(wiring.inputs[i].value, "inputs");
  }
}

bool is_heard(int pin) {
  const bbsim_wiring& wiring = board.wiring;
  if (pin == LED_BUILTIN || is_of_screen(pin) || is_trigger(pin) || is_of_stepper(pin)) return true;
  for (const bbsim_wired_servo& servo : wiring.servos) {
    if (servo.pin == pin) return true;
  }
  for (size_t i = 0; i < wiring.input_count; ++i) {
    if (wiring.inputs[i].pin == pin) return true;
  }
  for (size_t i = 0; i < wiring.ignored_count; ++i) {
    if (wiring.ignored[i] == pin) return true;
  }
  return false;
}

}  // namespace

double full_scale() {
  const int bits = first_bits != 0 ? first_bits : analog_bits;
  return static_cast<double>((1L << bits) - 1);
}

int unheard_pin(size_t n) {
  for (int pin = 0; pin < pins; ++pin) {
    if (state[pin].driven && !is_heard(pin) && n-- == 0) return pin;
  }
  return -1;
}

Drive drive_of(int pin) {
  if (pin < 0) return Drive::none;
  const Pin& wired = state[pin];
  if (wired.output) return wired.high ? Drive::high : Drive::low;
  return wired.high ? Drive::pull_up : Drive::none;
}

const char* pin_name(int pin) {
  static char name[16];
  snprintf(name, sizeof name, pin < first_analog ? "%d" : "A%d",
           pin < first_analog ? pin : pin - first_analog);
  return name;
}

void describe_last_read(char* text, size_t size) {
  if (last_read < 0) return;
  snprintf(text, size, "; it last read pin %s as %s", pin_name(last_read),
           last_level == HIGH ? "HIGH" : "LOW");
}

}  // namespace bbsim_board

using namespace bbsim_board;

void pinMode(int number, int mode) {
  Pin& pin = state[checked(number, "pinMode")];
  pin.output = mode == OUTPUT;
  if (mode == INPUT) pin.high = false;
  if (mode == INPUT_PULLUP) pin.high = true;
  pin.driven = pin.driven || (pin.output && pin.high);
  spend(board.costs.digital);
}

void digitalWrite(int number, int level) {
  Pin& pin = state[checked(number, "digitalWrite")];
  pin.high = level != LOW;
  pin.driven = pin.driven || (pin.output && pin.high);
  spend(board.costs.digital);
  if (!pin.output) return;
  trigger_distance(number, pin.high);
  step_motor(number, pin.high);
}

int digitalRead(int number) {
  const int read = level_of(checked(number, "digitalRead"), "digitalRead") > 0.5 ? HIGH : LOW;
  last_read = number;
  last_level = read;
  spend(board.costs.digital);
  return read;
}

int analogRead(int number) {
  if (number >= 0 && number < 16) number += first_analog;  // a channel number
  if (checked(number, "analogRead") < first_analog) {
    fail("analogRead(%d): pin %d is not analog; allowed: A0 to A15", number, number);
  }
  begin_reading();
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
  state[pin].output = state[pin].driven = true;
  spend(board.costs.digital);
}
