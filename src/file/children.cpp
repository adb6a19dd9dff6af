// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/children.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>

namespace bbsim::file {
namespace {

std::array<std::atomic<pid_t>, 1100> remembered;
std::atomic<pid_t> owner_of_children{0};
static_assert(std::atomic<pid_t>::is_always_lock_free, "a signal handler reads them");

}  // namespace

void remember_child(pid_t process) {
  owner_of_children.store(getpid());
  for (auto& place : remembered) {
    pid_t free = 0;
    if (place.compare_exchange_strong(free, process)) return;
  }
}

void forget_child(pid_t process) {
  for (auto& place : remembered) {
    pid_t found = process;
    if (place.compare_exchange_strong(found, 0)) return;
  }
}

std::optional<int> wait_for_child(pid_t process) {
  siginfo_t ended{};
  while (waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOWAIT) != 0 &&
         errno == EINTR) {
  }
  forget_child(process);
  int status = 0;
  return waitpid(process, &status, WNOHANG) == process ? std::optional(status) : std::nullopt;
}

void end_child(pid_t process) {
  kill(-process, SIGKILL);
  kill(process, SIGKILL);  // in case it left its group
}

void end_children() {
  if (owner_of_children.load() != getpid()) return;
  for (auto& place : remembered) {
    if (const pid_t process = place.load()) end_child(process);
  }
}

}  // namespace bbsim::file
