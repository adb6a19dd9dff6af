// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The controller that bbsim calls (bbsim/controller.h, bbsim/wiring.h). A sketch keeps its state in
// global variables, so each controller is a copy of this library of its own, which the linker loads
// from memory: the functions that bbsim calls only pass on to the copy's.
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

Nanoseconds switched_on_before = 0;  // t = 0, on the board's clock
double period = 0;                   // s
size_t column_count = 0;
constexpr int patience = 5;  // s

template <class T>
T* copy(const T* from, size_t count) {
  T* const made = static_cast<T*>(calloc(count + 1, sizeof(T)));
  if (made != nullptr && count > 0) memcpy(made, from, count * sizeof(T));
  return made;
}

// In a copy of the library. Returns why there can be no controller, if so.
const char* create(const bbsim_setup* setup, const bbsim_wiring* wiring) {
  static char why[200];
  if (setup->drives_acceleration != 0) return "a sketch moves servos; allowed: drives: angle";
  if (setup->parameter_count > 0) {
    snprintf(why, sizeof why, "a sketch takes no parameters, found %.60s; its numbers stand in it",
             setup->parameters[0].name);
    return why;
  }
  board.wiring = *wiring;
  bbsim_wiring& own = board.wiring;
  own.inputs = copy(own.inputs, own.input_count);
  own.ignored = copy(own.ignored, own.ignored_count);
  own.eeprom = copy(own.eeprom, own.eeprom_size);
  own.camera.frame = copy(own.camera.frame, strlen(own.camera.frame));
  own.camera.lost = copy(own.camera.lost, strlen(own.camera.lost));
  const bbsim_call_costs& costs = own.costs;
  board.costs = {
      nanoseconds(costs.clock), nanoseconds(costs.digital),      nanoseconds(costs.analog),
      nanoseconds(costs.servo), nanoseconds(costs.serial),       nanoseconds(costs.wire),
      nanoseconds(costs.spi),   nanoseconds(costs.eeprom_write), nanoseconds(costs.loop)};
  board.now = 0;
  period = setup->period;
  column_count = setup->column_count;
  watch_columns(setup->columns, column_count);
  return start_sketch() ? nullptr : "there is no memory for its stack";
}

// The board is on until setup() has returned; what it sees is the first sample. Then, for t = 0, it
// waits for the end of a whole number of periods.
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
    const double next = static_cast<double>(sample->number + 1) * period;  // sample's t
    board.horizon = switched_on_before + nanoseconds(next);
    send_frames();
    if (board.now < board.horizon) run_sketch();
  }
  if (board.said[0] != '\0') return 1;
  command[0] = board.command[0];
  command[1] = board.command[1];
  for (size_t i = 0; i < column_count; ++i) columns[i] = column(i);
  return 0;
}

const char* said() {
  return board.said;
}

// Called by the watchdog in the midst of the sketch, which is left there for good.
void stuck() {
  fail(
      "it computes without end: %d s of a processor, and no call that takes time, such as millis() "
      "or delay()",
      patience);
}

struct Functions {
  decltype(&create) make;
  decltype(&step) next;
  decltype(&said) why;
  decltype(&stuck) stop;
  decltype(&end_sketch) end;
};

struct Copy {
  int file;  // stays open: its number is the copy's name
  void* library;
  const Functions* functions;
};

// This library's own file.
struct Image {
  void* bytes = nullptr;
  size_t size = 0;
  Image() {
    Dl_info found{};
    if (dladdr(reinterpret_cast<const void*>(&bbsim_controller_abi), &found) == 0) return;
    std::FILE* const file = fopen(found.dli_fname, "rb");
    if (file == nullptr) return;
    fseek(file, 0, SEEK_END);
    const long length = ftell(file);
    rewind(file);
    bytes = length > 0 ? malloc(static_cast<size_t>(length)) : nullptr;
    if (bytes != nullptr) size = fread(bytes, 1, static_cast<size_t>(length), file);
    fclose(file);
  }
};

thread_local char why_not[400];

// A sketch that waits for what cannot come, as in while (1);, is found out by the processor time
// that a step takes: each thread has a timer of its own.
thread_local const Functions* present = nullptr;

class Watchdog {
 public:
  Watchdog() {
    struct sigaction action {};
    action.sa_handler = [](int) {
      if (present != nullptr) present->stop();
    };
    sigaction(watchdog_signal(), &action, nullptr);
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = watchdog_signal();
    event._sigev_un._tid = gettid();
    works_ = timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_) == 0;
  }
  ~Watchdog() {
    if (works_) timer_delete(timer_);
  }
  void set(int seconds) {
    const itimerspec when{{0, 0}, {seconds, 0}};
    if (works_) timer_settime(timer_, 0, &when, nullptr);
  }

 private:
  timer_t timer_{};
  bool works_ = false;
};

bool load(Copy& copy) {
  static const Image image;
  copy.file = memfd_create("sketch", MFD_CLOEXEC);
  if (image.size == 0 || copy.file < 0 ||
      ::write(copy.file, image.bytes, image.size) != static_cast<ssize_t>(image.size)) {
    snprintf(why_not, sizeof why_not, "its file cannot be copied");
    return false;
  }
  char name[40];
  snprintf(name, sizeof name, "/proc/self/fd/%d", copy.file);
  copy.library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (copy.library == nullptr) {
    snprintf(why_not, sizeof why_not, "its copy cannot be opened: %s", dlerror());
    return false;
  }
  copy.functions = static_cast<const Functions*>(dlsym(copy.library, "bbsim_sketch_functions"));
  return copy.functions != nullptr;
}

void drop(Copy* copy) {
  if (copy->library != nullptr) dlclose(copy->library);
  if (copy->file >= 0) close(copy->file);
  free(copy);
}

}  // namespace

int watchdog_signal() {
  return SIGRTMIN + 5;
}

}  // namespace bbsim_board

using namespace bbsim_board;

extern "C" {

BBSIM_CONTROLLER_EXPORT extern const Functions bbsim_sketch_functions;
const Functions bbsim_sketch_functions{create, step, said, stuck, end_sketch};

uint32_t bbsim_controller_abi() {
  return BBSIM_CONTROLLER_ABI;
}

void* bbsim_controller_create(const bbsim_setup*) {
  snprintf(
      why_not, sizeof why_not,
      "it is a sketch; allowed: with controller.library.wiring, a file that says what its pins "
      "are wired to");
  return nullptr;
}

void* bbsim_controller_create_wired(const bbsim_setup* setup, const bbsim_wiring* wiring) {
  if (wiring->version != BBSIM_WIRING_VERSION) {
    snprintf(why_not, sizeof why_not,
             "it was made by another version of bbsim sketch; make it anew");
    return nullptr;
  }
  Copy* const copy = static_cast<Copy*>(calloc(1, sizeof(Copy)));
  if (copy == nullptr) return nullptr;
  if (!load(*copy)) {
    drop(copy);
    return nullptr;
  }
  if (const char* const why = copy->functions->make(setup, wiring)) {
    snprintf(why_not, sizeof why_not, "%s", why);
    copy->functions->end();
    drop(copy);
    return nullptr;
  }
  return copy;
}

int bbsim_controller_step(void* controller, const bbsim_sample* sample, double command[2],
                          double* columns) {
  static thread_local Watchdog watchdog;
  present = static_cast<Copy*>(controller)->functions;
  watchdog.set(patience);
  const int code = present->next(sample, command, columns);
  watchdog.set(0);
  present = nullptr;
  return code;
}

void bbsim_controller_destroy(void* controller) {
  Copy* const copy = static_cast<Copy*>(controller);
  copy->functions->end();
  drop(copy);
}

const char* bbsim_controller_last_error(const void* controller) {
  return controller == nullptr ? why_not : static_cast<const Copy*>(controller)->functions->why();
}
}
