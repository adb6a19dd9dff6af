// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs part of a test in a process of its own.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

// How a process ends, as from waitpid(), that exits with what `action` returns.
template <class Action>
int status_of_child(Action action) {
  const pid_t child = fork();
  if (child == 0) _exit(action());
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}
