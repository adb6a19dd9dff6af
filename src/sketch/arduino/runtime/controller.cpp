// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sketch as a controller. Runs in a copy of the library (copies.cpp).
#include <signal.h>

#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

Nanoseconds switched_on_before = 0;  // time of t = 0 on the board's clock
double period = 0;                   // s
size_t column_count = 0;

bool is_wired(const bbsim_wired_servo& servo) {
  return servo.pin >= 0 || servo.channel >= 0;
}

bool has_legs(const bbsim_wiring& wiring) {
  return is_wired(wiring.servos[2]) || wiring.steppers[2].step >= 0;
}

// Returns null, or the reason why it refuses the setup.
const char* create(const bbsim_setup* setup, const bbsim_wiring* wiring) {
  if (!start_sketch()) return "out of memory for its stack";
  construct_globals();
  if (board.said[0] != '\0') return board.said;
  static char why[200];
  constexpr uint32_t angle = 0, legs = 4;
  if (setup->drives_acceleration != angle && setup->drives_acceleration != legs) {
    return "a sketch moves servos; allowed: drives: angle";
  }
  if ((setup->drives_acceleration == legs) != has_legs(*wiring)) {
    return "the wiring's servos and the scenario's differ; allowed: servos.legs, or steppers 1 to "
           "3, with drives: legs; phi and theta with drives: angle";
  }
  if (setup->parameter_count > 0) {
    snprintf(why, sizeof why,
             "a sketch takes no parameters, found %.60s; set the numbers in the sketch",
             setup->parameters[0].name);
    return why;
  }
  board.wiring = *wiring;
  bbsim_wiring& own = board.wiring;
  own.inputs = keep(own.inputs, own.input_count);
  own.ignored = keep(own.ignored, own.ignored_count);
  own.eeprom = keep(own.eeprom, own.eeprom_size);
  own.camera.frame = keep(own.camera.frame, strlen(own.camera.frame) + 1);
  own.camera.lost = keep(own.camera.lost, strlen(own.camera.lost) + 1);
  const bbsim_call_costs& costs = own.costs;
  board.costs = {
      nanoseconds(costs.clock), nanoseconds(costs.digital),      nanoseconds(costs.analog),
      nanoseconds(costs.servo), nanoseconds(costs.serial),       nanoseconds(costs.wire),
      nanoseconds(costs.spi),   nanoseconds(costs.eeprom_write), nanoseconds(costs.loop)};
  board.now = 0;
  period = setup->period;
  column_count = setup->column_count;
  watch_columns(setup->columns, column_count);
  return nullptr;
}

// Runs setup() before t = 0. It sees the first sample. t = 0 is then the next whole number of
// sampling periods on the board's clock.
void set_up() {
  board.horizon = 600 * 1000000000LL;
  run_sketch();
  if (board.said[0] != '\0') return;
  if (!setup_has_returned()) {
    char seen[160] = "", turns[160] = "";
    describe_last_read(seen, sizeof seen);
    describe_steppers(turns, sizeof turns);
    fail("setup() has not returned within 600 s of the board's clock%s%s", seen, turns);
    return;
  }
  const double periods = ceil(static_cast<double>(board.now) * 1e-9 / period);
  switched_on_before = nanoseconds(periods * period);
  board.now = switched_on_before;
}

int step(const bbsim_sample* sample, double* command, double* columns) {
  board.sample = *sample;
  if (board.said[0] == '\0' && sample->number == 0 && board.wiring.setup_before != 0) set_up();
  if (board.said[0] == '\0' && sample->number == 0) place_steppers();
  if (board.said[0] == '\0') {
    const double number = static_cast<double>(sample->number);
    board.horizon = switched_on_before + nanoseconds((number + 1) * period);
    send_frames();
    send_pending(switched_on_before + nanoseconds(number * period));
    if (board.now < board.horizon) run_sketch();
  }
  if (board.said[0] != '\0') return board.misfit ? BBSIM_WIRING_AT_FAULT : 1;
  command_steppers();
  // `command` has room for a third number only if three servos are wired.
  for (int i = 0; i < (has_legs(board.wiring) ? 3 : 2); ++i) {
    command[i] = board.command[i];
  }
  for (size_t i = 0; i < column_count; ++i) columns[i] = column(i);
  return 0;
}

const char* said() {
  return board.said;
}

void crashed(int signal, const void* address) {
  board.running = false;
  if (signal == watchdog_signal()) {
    return say_why(
        "it is in an endless loop: %d s of processor time without a call that takes time, such as "
        "millis() or delay()",
        patience);
  }
  if (signal == SIGFPE) return say_why("it divided an integer by zero");
  if (signal == SIGILL) {  // compilers end the function there
    return say_why(
        "it divided an integer by zero, or did something else that C++ leaves undefined");
  }
  if (signal == SIGABRT) return say_why("it called abort(), or damaged its memory");
  if (is_beyond_stack(address)) {
    return say_why(
        "its stack of 1 MB is full: a function calls itself without end, or a local "
        "variable is too large");
  }
  say_why("it crashed by signal %d (%s)", signal, strsignal(signal));
}

}  // namespace

const Functions functions{create,           step,         said,        crashed,
                          destroy_globals,  end_sketch,   was_printed, unheard_pin,
                          keep_for_program, take_printed, line_counts};

}  // namespace bbsim_board
