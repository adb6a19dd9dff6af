// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5_guard.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "base/error.hpp"
#include "base/fork_mutex.hpp"
#include "file/temporaries.hpp"

namespace bbsim::file {
namespace {

constexpr std::array<int, 4> crashes{SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
ForkMutex one_thread;  // within HDF5, because signal actions belong to the process
std::array<struct sigaction, crashes.size()> actions_before;

// The message for a crash of this thread; null outside HDF5.
thread_local const char* message_of_crash = nullptr;

// Ends the program with the message if this thread is within HDF5.
void end_if_within() {
  const char* const message = message_of_crash;
  if (message == nullptr) return;
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, message, std::strlen(message));
  remove_temporaries();
  _exit(static_cast<int>(ExitCode::output_failed));
}

void crashed(int /*signal*/) {
  // A crash of another thread recurs after the return and then meets the previous actions.
  end_if_within();
  for (std::size_t i = 0; i < crashes.size(); ++i) {
    sigaction(crashes[i], &actions_before[i], nullptr);
  }
}

// Handles signals on a separate stack, because HDF5 may fill the stack: it reports errors in
// reporting errors, in endless recursion.
void have_a_stack_for_signals() {
  // With AMX, a signal frame takes 11 kB.
  alignas(std::max_align_t) static std::array<char, 65536> bytes;
  stack_t before{};
  if (sigaltstack(nullptr, &before) != 0 || (before.ss_flags & SS_DISABLE) == 0) return;
  stack_t stack{};
  stack.ss_sp = bytes.data();
  stack.ss_size = bytes.size();
  sigaltstack(&stack, nullptr);
}

void watch_for_crashes() {
  have_a_stack_for_signals();
  struct sigaction action {};
  action.sa_handler = crashed;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < crashes.size(); ++i) {
    sigaction(crashes[i], &action, &actions_before[i]);
  }
  // Some HDF5 functions call exit(-1).
  [[maybe_unused]] static const int registered = std::atexit(end_if_within);
}

}  // namespace

WithinHdf5::WithinHdf5(const char* message) : before_(message_of_crash) {
  if (before_ == nullptr) {
    one_thread.lock();
    watch_for_crashes();
  }
  message_of_crash = message;
}

WithinHdf5::~WithinHdf5() {
  message_of_crash = before_;
  if (before_ != nullptr) return;
  for (std::size_t i = 0; i < crashes.size(); ++i) {
    sigaction(crashes[i], &actions_before[i], nullptr);
  }
  one_thread.unlock();
}

}  // namespace bbsim::file
