// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Processes that run beside this one, and what these have started: whatever ends them takes all of
// it along.
#pragma once

#include <sys/types.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace bbsim::file {

// The process of that id, and the group that it leads, are ended by end_children() until it is
// forgotten, which has to be before anybody waits for the process: afterwards the id may be
// another's. One that finds no place (of 1100: more than a sweep has threads) is only not ended.
void remember_child(pid_t process);
void forget_child(pid_t process);

// To be held while a process is started and until it is remembered: it is no orphan.
[[nodiscard]] std::unique_lock<std::mutex> while_starting_child();

// Waits for a process that is remembered, and forgets it. Its status; nothing if somebody else has
// taken that.
std::optional<int> wait_for_child(pid_t process);

// An entry of the environment, NAME=VALUE, that marks a new process and all that it will start: no
// other has it.
[[nodiscard]] std::string new_mark();

// What other processes leave behind comes to this one from now on, and so can be found.
void adopt_orphans();

// A process that is remembered, and all that comes of it: what it has started by now; its group;
// and what has its mark and came to us.
class Family {
 public:
  // Finds what it has started, in whatever groups.
  Family(pid_t head, std::string mark);

  // Ends all of that; waits for nothing.
  void end() const;
  // To be called once the head was waited for and is forgotten: ends what it has left to us, and
  // waits for that, a second at most.
  void bury() const;

 private:
  [[nodiscard]] bool has(pid_t process) const;

  pid_t head_;
  std::string mark_;
  std::vector<pid_t> members_;
};

// What a signal handler may call: ends all that is remembered, and what is marked and comes to us
// of it, within a part of a second. Does nothing in a process that was forked off.
void end_children();

}  // namespace bbsim::file
