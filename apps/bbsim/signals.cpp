// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Signals that end the program, such as Ctrl-C (terminal.hpp).
#include <unistd.h>

#include <csignal>

#include "base/error.hpp"
#include "file/leftovers.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

std::atomic<bool> watched{false}, end_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

void end(int) {
  if (watched.load(std::memory_order_relaxed) && !end_requested.exchange(true)) return;
  file::remove_temporaries();
  file::end_children();
  _exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace

void end_at_signals() {
  struct sigaction action {};
  action.sa_handler = end;
  sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // no SA_RESTART: a blocked write must return
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, &action, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) sigaction(signal, &before, nullptr);
  }
}

const std::atomic<bool>& watch_signals() {
  watched.store(true, std::memory_order_relaxed);
  return end_requested;
}

}  // namespace bbsim::app
