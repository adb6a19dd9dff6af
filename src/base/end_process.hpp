// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Ends the process at once, without cleanup.
#pragma once

#include <sys/syscall.h>
#include <unistd.h>

namespace bbsim {

// Acts like _exit(). bbsim overrides _exit() to catch calls from foreign libraries
// (controller/foreign_exit.cpp), so it needs this function. A signal handler may call it.
[[noreturn]] inline void end_process(int status) {
  for (;;) syscall(SYS_exit_group, status);
}

}  // namespace bbsim
