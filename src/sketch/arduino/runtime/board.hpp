// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The board that a sketch runs on. Each copy of the library has one (copies.cpp), so it is a global
// variable, like those of the sketch.
#pragma once

#include <bbsim/wiring.h>

#include "bbsim_board.h"

namespace bbsim_board {

using Nanoseconds = long long;

inline Nanoseconds nanoseconds(double seconds) {
  const double exact = seconds * 1e9;
  return static_cast<Nanoseconds>(exact < 0 ? exact - 0.5 : exact + 0.5);
}

constexpr int pins = 70;  // as on a Mega: A0 is pin 54
constexpr int first_analog = 54;

// The durations of calls.
struct Costs {
  Nanoseconds clock, digital, analog, servo, serial, wire, spi, eeprom_write, loop;
};

struct Board {
  bbsim_wiring wiring;
  Costs costs;
  bbsim_sample sample;  // the newest
  Nanoseconds now;      // since the board was switched on
  Nanoseconds horizon;  // the time of the next sample
  bool running;         // whether the coroutine is running
  bool constructing;    // whether it runs the constructors of global variables
  char said[400];       // the first error, or empty
  bool misfit;          // that error is the wiring's
  double command[3];    // rad
};
extern Board board;

// coroutine.cpp: runs the sketch until its clock reaches board.horizon, or an error.
bool start_sketch();  // false: out of memory
void run_sketch();
// Runs the constructors of global variables, which may fail.
void construct_globals();
// Runs the destructors of global variables and what the sketch gave to atexit(), unless it failed.
void destroy_globals();
void end_sketch();  // frees the stack and what keep() copied
// Copies data that the board needs until end_sketch(); zeros if `from` is null. It is no global
// object with a destructor, because none of these runs after a sketch has failed.
void* keep_bytes(const void* from, size_t size);
template <class Any>
Any* keep(const Any* from, size_t count) {
  return static_cast<Any*>(keep_bytes(from, count * sizeof(Any)));
}
bool setup_has_returned();
// Whether an access to this address is one beyond the end of the sketch's stack.
bool is_beyond_stack(const void* address);
// Suspends the sketch until the next run_sketch().
void hand_over();
// The signal that stops a sketch in an endless loop. It is sent to the thread of the sketch.
int watchdog_signal();
// Says why the sketch cannot go on. Unlike fail(), it does not leave the sketch: the caller does.
__attribute__((format(printf, 1, 2))) void say_why(const char* format, ...);

// controller.cpp: the functions of a copy of the library.
struct Functions {
  const char* (*make)(const bbsim_setup* setup, const bbsim_wiring* wiring);  // null, or the error
  int (*next)(const bbsim_sample* sample, double* command, double* columns);
  const char* (*why)();
  // A signal ended the sketch's code, which is not resumed. `address`: of a wrong access.
  void (*crashed)(int signal, const void* address);
  void (*destroy)();  // see destroy_globals()
  void (*end)();
  bool (*printed)(size_t column);  // see was_printed()
  int (*unheard)(size_t n);        // see unheard_pin()
  // See keep_for_program(), take_printed() and line_counts().
  void (*send)(const char* bytes, size_t size, double delay);
  size_t (*receive)(char* bytes, size_t room);
  bbsim_line (*line)();
};
extern const Functions functions;
constexpr int patience = 5;  // limit of processor time for a step, s

// screen.cpp: the level (0 to 1) of a pin of the screen. Returns false for other pins.
bool screen_reads(int pin, double& level);
bool is_of_screen(int pin);
double counts_at(const bbsim_count_map& map, double position);

// distances.cpp: the level of an echo pin, false for other pins; what a trigger pin does.
bool distance_reads(int pin, double& level);
void trigger_distance(int pin, bool high);
bool is_trigger(int pin);

// steppers.cpp: what a step pin does, and the level of a limit switch's pin, false for other pins.
bool has_steppers();
void step_motor(int pin, bool high);
bool limit_switch_reads(int pin, double& level);
bool is_of_stepper(int pin);
void place_steppers();  // at t = 0, after a setup() before it; may say why not
// For an error: "; the shafts have turned by 3 deg and ..."; empty without steppers.
void describe_steppers(char* text, size_t size);
void command_steppers();  // sets board.command

// pins.cpp: how a pin drives its wire.
enum class Drive { none, pull_up, low, high };
Drive drive_of(int pin);
const char* pin_name(int pin);
// For an error: "; it last read pin 5 as HIGH"; empty if it has read none.
void describe_last_read(char* text, size_t size);
// The n-th pin that the sketch drives although nothing is wired to it; -1: there are no more.
int unheard_pin(size_t n);
// What a full reading of the analog converter counts, by the bits that are set at the first
// reading: those of the wiring's counts.
double full_scale();

// core.cpp: spends the time of a bus transaction. `bytes` does not count the bus address.
void over_wire(int bytes);
void over_spi(int bytes);
// The number as text that ends at `end`, with `ten` as its eleventh digit. Returns its begin.
char* digits_of(unsigned long long value, int base, char ten, char* end);

// serial.cpp: sends the camera's frames up to now.
void send_frames();
// Keeps what a program sends to Serial, and sends it at the time of a sample.
void keep_for_program(const char* bytes, size_t size, double delay);
void send_pending(Nanoseconds sample);
// Takes what has arrived at the program by the horizon.
size_t take_printed(char* bytes, size_t room);
bbsim_line line_counts();
// column(i) is the last number that was printed after names[i] and a colon, NaN before the first.
void watch_columns(const char* const* names, size_t count);
double column(size_t index);
bool was_printed(size_t index);

}  // namespace bbsim_board
