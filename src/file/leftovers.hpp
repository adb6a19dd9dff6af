// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Temporary files and child processes that must not outlive this process: a signal that ends it
// removes them.
#pragma once

#include <sys/types.h>

#include <optional>

namespace bbsim::file {

// remove_temporaries() removes `name` until forget_temporary(). The characters must stay in place
// until then. There is room for 64 names; further ones are not removed.
void remember_temporary(const char* name);
void forget_temporary(const char* name);

// A signal handler may call this. Does nothing in a forked process.
void remove_temporaries();

// Until forget_child(), end_children() ends `process` and its group. Call forget_child() before
// waiting for the process, because its id may be reused afterwards. There is room for 1100
// processes, more than a sweep has threads; further ones are not ended.
void remember_child(pid_t process);
void forget_child(pid_t process);

// Waits for a remembered process and forgets it. Returns its status, or nothing if other code has
// already collected it.
std::optional<int> wait_for_child(pid_t process);

// Kills a process that was not waited for yet, and its group.
void end_child(pid_t process);

// Kills all remembered processes and their groups. A signal handler may call it. Does nothing in a
// forked process.
void end_children();

}  // namespace bbsim::file
