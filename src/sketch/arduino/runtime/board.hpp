// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The board that a sketch runs on. There is one in each copy of the library (copies.cpp), so it
// is a global variable, as the sketch's own are.
#pragma once

#include <bbsim/wiring.h>

#include "bbsim_board.h"

namespace bbsim_board {

using Nanoseconds = long long;

inline Nanoseconds nanoseconds(double seconds) {
  const double exact = seconds * 1e9;
  return static_cast<Nanoseconds>(exact < 0 ? exact - 0.5 : exact + 0.5);
}

constexpr int pins = 70;  // as of a Mega: A0 is 54
constexpr int first_analog = 54;

// What the calls cost.
struct Costs {
  Nanoseconds clock, digital, analog, servo, serial, wire, spi, eeprom_write, loop;
};

struct Board {
  bbsim_wiring wiring;
  Costs costs;
  bbsim_sample sample;  // the newest
  Nanoseconds now;      // since the board was switched on
  Nanoseconds horizon;  // of the present step: from there on the next sample is due
  bool running;         // in the sketch, that is, on the coroutine
  char said[400];       // what went wrong; empty: nothing did
  double command[2];    // rad
};
extern Board board;

// coroutine.cpp: runs the sketch until its clock reaches board.horizon, or something goes wrong.
bool start_sketch();  // false: there is no memory
void run_sketch();
void end_sketch();
bool setup_has_returned();
// Gives control back from within the sketch, until the next run_sketch().
void hand_over();
// Sent to the thread of a sketch that computes without end.
int watchdog_signal();

// controller.cpp: what a copy of the library does.
struct Functions {
  const char* (*make)(const bbsim_setup* setup, const bbsim_wiring* wiring);  // why not; null: done
  int (*next)(const bbsim_sample* sample, double* command, double* columns);
  const char* (*why)();
  void (*stop)();
  void (*end)();
};
extern const Functions functions;
constexpr int patience = 5;  // s of a processor that a step may take

// screen.cpp: what a pin reads that the screen is wired to, of 1; false: it is not.
bool screen_reads(int pin, double& level);
double counts_at(const bbsim_count_map& map, double position);

// pins.cpp: a pin as a driver of what is wired to it.
enum class Drive { none, pull_up, low, high };
Drive drive_of(int pin);
const char* pin_name(int pin);

// core.cpp: so many bytes go over a bus, behind the address of who is meant.
void over_wire(int bytes);
void over_spi(int bytes);

// serial.cpp: the camera's frames up to now are on their way.
void send_frames();
// The last number that was printed after `name` and a colon.
void watch_columns(const char* const* names, size_t count);
double column(size_t index);

}  // namespace bbsim_board
