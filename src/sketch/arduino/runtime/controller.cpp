// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sketch as a controller. Runs in a copy of the library (copies.cpp).
#include <vector>

#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

Nanoseconds switched_on_before = 0;  // time of t = 0 on the board's clock
double period = 0;                   // s
size_t column_count = 0;

// The data that board.wiring points to. They live as long as this copy of the library.
std::vector<bbsim_wired_input> inputs;
std::vector<int32_t> ignored;
std::vector<unsigned char> eeprom;
std::string frame, lost;

template <class Any>
const Any* keep(std::vector<Any>& in, const Any* from, size_t count) {
  in.assign(from, from + count);
  return in.data();
}

bool is_wired(const bbsim_wired_servo& servo) {
  return servo.pin >= 0 || servo.channel >= 0;
}

// Returns null, or the reason why it refuses the setup.
const char* create(const bbsim_setup* setup, const bbsim_wiring* wiring) {
  if (board.said[0] != '\0') return board.said;  // by a global variable's constructor
  static char why[200];
  constexpr uint32_t angle = 0, legs = 4;
  if (setup->drives_acceleration != angle && setup->drives_acceleration != legs) {
    return "a sketch moves servos; allowed: drives: angle";
  }
  if ((setup->drives_acceleration == legs) != is_wired(wiring->servos[2])) {
    return "the wiring's servos and the scene's differ; allowed: servos.legs with drives: legs, "
           "servos.phi and .theta with drives: angle";
  }
  if (setup->parameter_count > 0) {
    snprintf(why, sizeof why,
             "a sketch takes no parameters, found %.60s; set the numbers in the sketch",
             setup->parameters[0].name);
    return why;
  }
  board.wiring = *wiring;
  bbsim_wiring& own = board.wiring;
  own.inputs = keep(inputs, own.inputs, own.input_count);
  own.ignored = keep(ignored, own.ignored, own.ignored_count);
  own.eeprom = keep(eeprom, own.eeprom, own.eeprom_size);
  own.camera.frame = (frame = own.camera.frame).c_str();
  own.camera.lost = (lost = own.camera.lost).c_str();
  const bbsim_call_costs& costs = own.costs;
  board.costs = {
      nanoseconds(costs.clock), nanoseconds(costs.digital),      nanoseconds(costs.analog),
      nanoseconds(costs.servo), nanoseconds(costs.serial),       nanoseconds(costs.wire),
      nanoseconds(costs.spi),   nanoseconds(costs.eeprom_write), nanoseconds(costs.loop)};
  board.now = 0;
  period = setup->period;
  column_count = setup->column_count;
  watch_columns(setup->columns, column_count);
  return start_sketch() ? nullptr : "out of memory for its stack";
}

// Runs setup() before t = 0. It sees the first sample. t = 0 is then the next whole number of
// sampling periods on the board's clock.
void set_up() {
  board.horizon = 600 * 1000000000LL;
  run_sketch();
  if (board.said[0] != '\0') return;
  if (!setup_has_returned()) {
    fail("setup() has not returned within 600 s of the board's clock");
    return;
  }
  const double periods = ceil(static_cast<double>(board.now) * 1e-9 / period);
  switched_on_before = nanoseconds(periods * period);
  board.now = switched_on_before;
}

int step(const bbsim_sample* sample, double* command, double* columns) {
  board.sample = *sample;
  if (board.said[0] == '\0' && sample->number == 0 && board.wiring.setup_before != 0) set_up();
  if (board.said[0] == '\0') {
    const double next = static_cast<double>(sample->number + 1) * period;  // s
    board.horizon = switched_on_before + nanoseconds(next);
    send_frames();
    if (board.now < board.horizon) run_sketch();
  }
  if (board.said[0] != '\0') return 1;
  // `command` has room for a third number only if three servos are wired.
  for (int i = 0; i < (is_wired(board.wiring.servos[2]) ? 3 : 2); ++i) {
    command[i] = board.command[i];
  }
  for (size_t i = 0; i < column_count; ++i) columns[i] = column(i);
  return 0;
}

const char* said() {
  return board.said;
}

// The watchdog calls this while the sketch runs. The sketch is not resumed.
void stuck() {
  fail(
      "it is in an endless loop: %d s of processor time without a call that takes time, such as "
      "millis() or delay()",
      patience);
}

}  // namespace

const Functions functions{create, step, said, stuck, end_sketch};

}  // namespace bbsim_board
