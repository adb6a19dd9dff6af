// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The functions that bbsim calls (bbsim/controller.h, bbsim/wiring.h). A sketch keeps its state in
// global variables, so each controller is a copy of this library, which the linker loads from
// memory. The functions here call those of the copy. The code has no thread_local variables,
// because each copy would have them in each thread.
#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "Arduino.h"
#include "runtime/board.hpp"

namespace bbsim_board {
namespace {

struct Copy {
  int file;  // stays open, because its number is in the copy's name
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

// The data of one thread.
struct Thread {
  char why_not[400];  // the error of the last create()
  const Functions* running;
  timer_t timer;
  bool has_timer;
};

void forget(void* thread) {
  if (static_cast<Thread*>(thread)->has_timer) timer_delete(static_cast<Thread*>(thread)->timer);
  free(thread);
}

pthread_key_t key() {
  static const pthread_key_t made = [] {
    pthread_key_t one{};
    pthread_key_create(&one, forget);
    return one;
  }();
  return made;
}

// Sets up a limit on the processor time of a step, to stop endless loops such as while (1);.
void watch(Thread& thread) {
  struct sigaction action {};
  action.sa_flags = SA_RESTART;
  action.sa_handler = [](int) {
    const auto* const own = static_cast<const Thread*>(pthread_getspecific(key()));
    if (own != nullptr && own->running != nullptr) own->running->stop();
  };
  sigaction(watchdog_signal(), &action, nullptr);
  sigevent event{};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = watchdog_signal();
  event._sigev_un._tid = gettid();
  thread.has_timer = timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &thread.timer) == 0;
}

Thread& this_thread() {
  auto* own = static_cast<Thread*>(pthread_getspecific(key()));
  if (own == nullptr) {
    own = static_cast<Thread*>(calloc(1, sizeof(Thread)));
    if (own == nullptr) abort();
    pthread_setspecific(key(), own);
    watch(*own);
  }
  return *own;
}

void set_timer(const Thread& thread, int seconds) {
  const itimerspec when{{0, 0}, {seconds, 0}};
  if (thread.has_timer) timer_settime(thread.timer, 0, &when, nullptr);
}

__attribute__((format(printf, 1, 2))) void refuse(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(this_thread().why_not, sizeof(Thread::why_not), format, arguments);
  va_end(arguments);
}

bool load(Copy& copy) {
  static const Image image;
  copy.file = memfd_create("sketch", MFD_CLOEXEC);
  if (image.size == 0 || copy.file < 0 ||
      ::write(copy.file, image.bytes, image.size) != static_cast<ssize_t>(image.size)) {
    refuse("cannot copy its file");
    return false;
  }
  char name[40];
  snprintf(name, sizeof name, "/proc/self/fd/%d", copy.file);
  copy.library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (copy.library == nullptr) {
    refuse("cannot open its copy: %s", dlerror());
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
const Functions bbsim_sketch_functions = functions;

uint32_t bbsim_controller_abi() {
  return BBSIM_CONTROLLER_ABI;
}

void* bbsim_controller_create(const bbsim_setup*) {
  refuse(
      "it is a sketch; allowed: with controller.library.wiring, a file that says what its pins "
      "are wired to");
  return nullptr;
}

void* bbsim_controller_create_wired(const bbsim_setup* setup, const bbsim_wiring* wiring) {
  if (wiring->version != BBSIM_WIRING_VERSION) {
    refuse("another version of bbsim sketch compiled it; compile it again");
    return nullptr;
  }
  Copy* const copy = static_cast<Copy*>(calloc(1, sizeof(Copy)));
  if (copy == nullptr) return nullptr;
  if (!load(*copy)) {
    drop(copy);
    return nullptr;
  }
  if (const char* const why = copy->functions->make(setup, wiring)) {
    refuse("%s", why);
    copy->functions->end();
    drop(copy);
    return nullptr;
  }
  return copy;
}

int bbsim_controller_step(void* controller, const bbsim_sample* sample, double command[2],
                          double* columns) {
  Thread& thread = this_thread();
  thread.running = static_cast<Copy*>(controller)->functions;
  set_timer(thread, patience);
  const int code = thread.running->next(sample, command, columns);
  set_timer(thread, 0);
  thread.running = nullptr;
  return code;
}

void bbsim_controller_destroy(void* controller) {
  Copy* const copy = static_cast<Copy*>(controller);
  copy->functions->end();
  drop(copy);
}

const char* bbsim_controller_last_error(const void* controller) {
  return controller == nullptr ? this_thread().why_not
                               : static_cast<const Copy*>(controller)->functions->why();
}
}
