// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/leftovers.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>

namespace bbsim::file {
namespace {

// Names or ids that this process remembers. A forked process has none of them.
template <class Thing, int most>
struct Remembered {
  std::atomic<Thing> places[most]{};
  std::atomic<pid_t> owner{0};
  static_assert(std::atomic<Thing>::is_always_lock_free, "a signal handler reads them");
  static_assert(std::atomic<pid_t>::is_always_lock_free, "a signal handler reads it");

  void put(Thing thing) {
    owner.store(getpid());
    for (auto& place : places) {
      Thing free{};
      if (place.compare_exchange_strong(free, thing)) return;
    }
  }
  void forget(Thing thing) {
    for (auto& place : places) {
      Thing found = thing;
      if (place.compare_exchange_strong(found, Thing{})) return;
    }
  }
  template <class Use>
  void for_each(Use use) const {
    if (owner.load() != getpid()) return;
    for (const auto& place : places) {
      if (const Thing thing = place.load()) use(thing);
    }
  }
};

constinit Remembered<const char*, 64> temporaries;
constinit Remembered<pid_t, 1100> children;

}  // namespace

void remember_temporary(const char* name) {
  temporaries.put(name);
}
void forget_temporary(const char* name) {
  temporaries.forget(name);
}
void remove_temporaries() {
  temporaries.for_each([](const char* name) { unlink(name); });
}

void remember_child(pid_t process) {
  children.put(process);
}
void forget_child(pid_t process) {
  children.forget(process);
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
  children.for_each(end_child);
}

}  // namespace bbsim::file
