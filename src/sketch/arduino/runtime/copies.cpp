// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The functions that bbsim calls (bbsim/controller.h, bbsim/wiring.h). A sketch keeps its state in
// global variables, so each controller is a copy of this library, which the linker loads from
// memory. The functions here call those of the copy. The code has no thread_local variables,
// because each copy would have them in each thread.
#include <dlfcn.h>
#include <pthread.h>
#include <setjmp.h>
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
  sigjmp_buf back;  // where a crash of `running` leads
  void* signal_stack;
  timer_t timer;
  bool has_timer;
};

void forget(void* thread) {
  auto* const own = static_cast<Thread*>(thread);
  if (own->has_timer) timer_delete(own->timer);
  if (own->signal_stack != nullptr) {
    const stack_t none{nullptr, SS_DISABLE, 0};
    sigaltstack(&none, nullptr);
    free(own->signal_stack);
  }
  free(thread);
}

pthread_key_t key() {
  static const pthread_key_t own = [] {
    pthread_key_t created{};
    pthread_key_create(&created, forget);
    return created;
  }();
  return own;
}

// The signals by which code crashes, and what they did before.
constexpr int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
struct sigaction before[sizeof crashes / sizeof *crashes];

// A crash of the sketch's code abandons that code: it has its own stack and global variables, and
// holds no lock of bbsim's. The handler may not return, because the instruction would run again.
void handle(int signal, siginfo_t* info, void*) {
  auto* const own = static_cast<Thread*>(pthread_getspecific(key()));
  if (own != nullptr && own->running != nullptr) {
    own->running->crashed(signal, info->si_addr);
    siglongjmp(own->back, 1);
  }
  for (size_t i = 0; i < sizeof crashes / sizeof *crashes; ++i) {
    if (crashes[i] == signal) sigaction(signal, &before[i], nullptr);  // and crash again
  }
}

// Catches crashes in this process, and gives this thread a stack for the handler and a limit of
// processor time, for endless loops such as while (1);.
void watch(Thread& thread) {
  struct sigaction action {};
  action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_RESTART;
  action.sa_sigaction = handle;
  static const bool installed = [&action] {
    for (size_t i = 0; i < sizeof crashes / sizeof *crashes; ++i) {
      sigaction(crashes[i], &action, &before[i]);
    }
    return sigaction(watchdog_signal(), &action, nullptr) == 0;
  }();
  static_cast<void>(installed);
  stack_t stack{};
  if (sigaltstack(nullptr, &stack) == 0 && (stack.ss_flags & SS_DISABLE) != 0) {
    stack.ss_size = 65536;
    stack.ss_flags = 0;
    stack.ss_sp = thread.signal_stack = malloc(stack.ss_size);
    if (stack.ss_sp != nullptr) sigaltstack(&stack, nullptr);
  }
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

// Calls the sketch's code. Returns false if it crashed or is in an endless loop; why() then says
// so.
template <class Call>
bool guarded(const Functions* functions, Call call) {
  Thread& thread = this_thread();
  thread.running = functions;
  set_timer(thread, patience);
  const bool well = sigsetjmp(thread.back, 1) == 0;
  if (well) call();
  set_timer(thread, 0);
  thread.running = nullptr;
  return well;
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
  const char* why = nullptr;
  const bool well = guarded(copy->functions, [&] { why = copy->functions->make(setup, wiring); });
  if (!well) why = copy->functions->why();
  if (why == nullptr) return copy;
  refuse("%s", why);
  copy->functions->end();
  drop(copy);
  return nullptr;
}

int bbsim_controller_step(void* controller, const bbsim_sample* sample, double command[2],
                          double* columns) {
  const Functions* const functions = static_cast<Copy*>(controller)->functions;
  int code = 1;
  return guarded(functions, [&] { code = functions->next(sample, command, columns); }) ? code : 1;
}

void bbsim_controller_destroy(void* controller) {
  Copy* const copy = static_cast<Copy*>(controller);
  guarded(copy->functions, [&] { copy->functions->destroy(); });
  copy->functions->end();
  drop(copy);
}

int bbsim_sketch_printed(const void* controller, size_t column) {
  return static_cast<const Copy*>(controller)->functions->printed(column) ? 1 : 0;
}

int bbsim_sketch_unheard(const void* controller, size_t n) {
  return static_cast<const Copy*>(controller)->functions->unheard(n);
}

void bbsim_sketch_send(void* controller, const char* bytes, size_t size, double delay) {
  static_cast<Copy*>(controller)->functions->send(bytes, size, delay);
}

size_t bbsim_sketch_receive(void* controller, char* bytes, size_t room) {
  return static_cast<Copy*>(controller)->functions->receive(bytes, room);
}

bbsim_line bbsim_sketch_line(const void* controller) {
  return static_cast<const Copy*>(controller)->functions->line();
}

const char* bbsim_controller_last_error(const void* controller) {
  return controller == nullptr ? this_thread().why_not
                               : static_cast<const Copy*>(controller)->functions->why();
}
}
