// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/foreign_exit.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>

#include "base/end_process.hpp"
#include "base/error.hpp"
#include "base/fork_mutex.hpp"
#include "base/quoted.hpp"
#include "file/children.hpp"
#include "file/temporaries.hpp"

namespace bbsim::controller {
namespace {

// Where to leave a call in this thread, and why.
struct Call {
  std::jmp_buf left{};
  const char* volatile function = nullptr;
  volatile int status = 0;
};
thread_local Call* present = nullptr;
thread_local bool cannot_return = false;

// The process that has opened a library; 0 before. Processes forked by a library end freely.
std::atomic<pid_t> expecting{0};
// Printed if the process ends from outside a call; never freed.
std::atomic<const char*> message{nullptr};

[[noreturn]] void end_with_message() {
  if (const char* const text = message.load()) std::fputs(text, stderr);
  file::remove_temporaries();
  file::end_children();
  end_process(static_cast<int>(ExitCode::ended_early));
}

// Calls the C library's own function.
[[noreturn]] void pass_on(const char* function, int status) {
  if (void* const own = dlsym(RTLD_NEXT, function)) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as dlsym gives functions
    reinterpret_cast<void (*)(int)>(own)(status);
  }
  end_process(status);
}

// Handles a library's call of `function`. Returns only if the function is to end the process after
// all.
void leave(const char* function, int status) {
  if (expecting.load() == 0 || expecting.load() != getpid()) return;
  if (present == nullptr || cannot_return) end_with_message();
  present->function = function;
  present->status = status;
  std::longjmp(present->left, 1);
}

// Handles exit() called inside the C library, as by err(), which bypasses the functions below.
void ended_within_a_call() {
  if (present != nullptr && expecting.load() == getpid()) end_with_message();
}

}  // namespace

std::string ExitCalled::text() const {
  return "it called " + std::string(function_) + '(' + std::to_string(status_) +
         "), which would have ended bbsim";
}

void expect_foreign_exits(const std::string& path) {
  const std::string text =
      "the controller (" + shown(path, uncut) + ") ended bbsim; unwritten output is lost\n";
  // Kept until the process ends, because any thread may end it and print one of them.
  static ForkMutex guard;
  static auto* const texts = new std::set<std::string>;
  {
    const std::lock_guard lock(guard);
    message.store(texts->insert(text).first->c_str());
  }
  if (expecting.exchange(getpid()) == 0) {
    [[maybe_unused]] static const int registered = std::atexit(ended_within_a_call);
  }
}

CannotReturn::CannotReturn() {
  cannot_return = true;
}

CannotReturn::~CannotReturn() {
  cannot_return = false;
}

void call_foreign(void (*function)(void*), void* data) {
  Call call;
  Call* volatile before = present;
  if (setjmp(call.left) == 0) {
    present = &call;
    try {
      function(data);
    } catch (...) {
      present = before;
      throw;
    }
    present = before;
    return;
  }
  present = before;
  throw ExitCalled(call.function, call.status);
}

}  // namespace bbsim::controller

// Replacements of the C library's functions that end a process, for all code in this program. None
// of them returns, as its header says. The program exports them; bbsim as a library does not.
#pragma GCC visibility push(default)
extern "C" {

void exit(int status) noexcept {
  bbsim::controller::leave("exit", status);
  bbsim::controller::pass_on("exit", status);
}

void quick_exit(int status) noexcept {
  bbsim::controller::leave("quick_exit", status);
  bbsim::controller::pass_on("quick_exit", status);
}

void _exit(int status) {
  bbsim::controller::leave("_exit", status);
  bbsim::end_process(status);
}

void _Exit(int status) noexcept {
  bbsim::controller::leave("_Exit", status);
  bbsim::end_process(status);
}
}
#pragma GCC visibility pop
