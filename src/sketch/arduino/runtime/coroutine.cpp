// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the sketch on its own stack. Calls advance the board's clock by their duration (spend). When
// the clock reaches the next sample, the call returns control to bbsim, and continues later.
#include <cxxabi.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <ucontext.h>

#include <exception>

#include "Arduino.h"
#include "runtime/board.hpp"

void serialEvent() __attribute__((weak));

// Between these are the constructors of global variables (constructors.ld).
using Constructor = void (*)(int, char**, char**);
extern "C" __attribute__((visibility("hidden"))) Constructor bbsim_constructors_begin[],
    bbsim_constructors_end[];

// Defined by the leak sanitizer. A sketch never returns, so the memory that it holds is not a leak.
extern "C" {
void __lsan_disable() __attribute__((weak));
void __lsan_enable() __attribute__((weak));
}

namespace bbsim_board {

Board board;

namespace {

constexpr size_t stack_size = size_t{1} << 20;
constexpr size_t guard_size = size_t{1} << 16;  // an overflow of the stack is a signal
ucontext_t outside, inside;
void* stack = MAP_FAILED;
void* kept[8];
size_t kept_count = 0;
bool setup_returned = false;

// What is to be called at the end, newest first.
struct AtEnd {
  void (*function)(void*);
  void* argument;
  AtEnd* next;
};
AtEnd* at_end = nullptr;

void run_all() {
  board.constructing = true;
  for (Constructor* one = bbsim_constructors_begin; one != bbsim_constructors_end; ++one) {
    (*one)(0, nullptr, nullptr);
  }
  board.constructing = false;
  hand_over();
  setup();
  setup_returned = true;
  if (board.wiring.setup_before != 0) hand_over();
  while (true) {
    loop();
    if (serialEvent != nullptr && Serial.available() > 0) serialEvent();
    spend(board.costs.loop);
  }
}

void body() {
  try {
    run_all();
  } catch (const std::exception& thrown) {
    fail("it threw an exception, which a board does not catch: %s", thrown.what());
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (...) {
    fail("it threw an exception, which a board does not catch");
  }
}

}  // namespace

void construct_globals() {
  run_sketch();
}

void destroy_globals() {
  while (at_end != nullptr && board.said[0] == '\0') {
    AtEnd* const one = at_end;
    at_end = one->next;
    one->function(one->argument);
    free(one);
  }
}

bool is_beyond_stack(const void* address) {
  const char* const at = static_cast<const char*>(address);
  const char* const begin = static_cast<const char*>(stack);
  return stack != MAP_FAILED && at >= begin && at < begin + guard_size;
}

bool start_sketch() {
  stack = mmap(nullptr, stack_size, PROT_READ | PROT_WRITE,
               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (stack == MAP_FAILED || mprotect(stack, guard_size, PROT_NONE) != 0) return false;
  getcontext(&inside);
  inside.uc_stack.ss_sp = stack;
  inside.uc_stack.ss_size = stack_size;
  inside.uc_link = nullptr;
  sigdelset(&inside.uc_sigmask, watchdog_signal());
  makecontext(&inside, body, 0);
  return true;
}

void run_sketch() {
  board.running = true;
  if (__lsan_disable != nullptr) __lsan_disable();
  swapcontext(&outside, &inside);
  if (__lsan_enable != nullptr) __lsan_enable();
  board.running = false;
}

void hand_over() {
  swapcontext(&inside, &outside);
}

void end_sketch() {
  if (stack != MAP_FAILED) munmap(stack, stack_size);
  stack = MAP_FAILED;
  while (kept_count > 0) free(kept[--kept_count]);
}

void* keep_bytes(const void* from, size_t size) {
  void* const copy = calloc(1, size + 1);
  if (copy == nullptr || kept_count == sizeof kept / sizeof *kept) abort();
  kept[kept_count++] = copy;
  return from == nullptr ? copy : memcpy(copy, from, size);
}

bool setup_has_returned() {
  return setup_returned;
}

void spend(long long time) {
  if (!board.running || board.constructing) return;  // a global variable's constructor
  board.now += time;
  while (board.now >= board.horizon) hand_over();
}

void say_why(const char* format, ...) {
  if (board.said[0] != '\0') return;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(board.said, sizeof board.said, format, arguments);
  va_end(arguments);
}

void fail(const char* format, ...) {
  if (board.constructing) {
    say_why(
        "a global variable uses the board before setup(); allowed: pins, servos, screens and the "
        "EEPROM from setup() on");
  } else if (board.said[0] == '\0') {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(board.said, sizeof board.said, format, arguments);
    va_end(arguments);
  }
  while (board.running) hand_over();
}

long long now() {
  return board.now;
}

}  // namespace bbsim_board

using namespace bbsim_board;

// Takes the place of the C library's function, which would call the destructors of the sketch's
// global variables as its library is closed, outside all guards. atexit() comes here, too. clang
// refuses a hidden function with the name that <cxxabi.h> declares, so the code has another.
extern "C" __attribute__((visibility("hidden"))) int bbsim_atexit(void (*function)(void*),
                                                                  void* argument,
                                                                  void*) __asm__("__cxa_atexit");
int bbsim_atexit(void (*function)(void*), void* argument, void*) {
  auto* const last = static_cast<AtEnd*>(malloc(sizeof(AtEnd)));
  if (last == nullptr) return -1;
  *last = {function, argument, at_end};
  at_end = last;
  return 0;
}

// exit() of a sketch (Arduino.h).
void sketch_exit(int status) {
  say_why("it called exit(%d)", status);
  fail("it called exit(%d)", status);
  abort();
}

unsigned long millis() {
  spend(board.costs.clock);
  return static_cast<unsigned long>(board.now / 1000000);
}

unsigned long micros() {
  spend(board.costs.clock);
  return static_cast<unsigned long>(board.now / 1000);
}

void delay(unsigned long ms) {
  spend(static_cast<long long>(ms) * 1000000);
}

void delayMicroseconds(unsigned int us) {
  spend(static_cast<long long>(us) * 1000);
}

void yield() {
  spend(board.costs.clock);
}
