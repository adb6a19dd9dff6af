// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps track of child processes and their descendants, so that all of them end with this process.
#pragma once

#include <sys/types.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/fork_mutex.hpp"

namespace bbsim::file {

// Until forget_child(), end_children() ends `process` and its group. Call forget_child() before
// waiting for the process, because its id may be reused afterwards. There is room for 1100
// processes, more than a sweep has threads; further ones are not ended.
void remember_child(pid_t process);
void forget_child(pid_t process);

// Hold this lock from the start of a process until remember_child(). Otherwise bury() may take the
// process for an orphan.
[[nodiscard]] std::unique_lock<ForkMutex> while_starting_child();

// Waits for a remembered process and forgets it. Returns its status, or nothing if other code has
// already collected it.
std::optional<int> wait_for_child(pid_t process);

// A unique environment entry, NAME=VALUE, that marks a new process and all its descendants.
[[nodiscard]] std::string new_mark();

// From now on, orphaned descendants become children of this process, which can then find them.
void adopt_orphans();

// A remembered process with its descendants: those that exist now, its group, and orphans with its
// mark that this process adopts later.
class Family {
 public:
  // Finds the current descendants, in any group.
  Family(pid_t head, std::string mark);

  // Kills them all without waiting.
  void end() const;
  // Call this after the head was waited for and forgotten. Kills its orphans and waits for them, at
  // most one second.
  void bury() const;

 private:
  [[nodiscard]] bool has(pid_t process) const;

  pid_t head_;
  std::string mark_;
  std::vector<pid_t> members_;
};

// Ends all remembered processes, their groups, and their adopted orphans, within 200 ms. A signal
// handler may call it. Does nothing in a forked process.
void end_children();

}  // namespace bbsim::file
