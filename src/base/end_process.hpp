// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How bbsim itself ends the process at once.
#pragma once

#include <sys/syscall.h>
#include <unistd.h>

namespace bbsim {

// As _exit() does, which in this program says what becomes of a library that calls it
// (controller/foreign_exit.cpp). A signal handler may call it.
[[noreturn]] inline void end_process(int status) {
  for (;;) syscall(SYS_exit_group, status);
}

}  // namespace bbsim
