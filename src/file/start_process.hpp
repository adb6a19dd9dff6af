// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Starts processes. No other code does.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace bbsim::file {

// The start of a process. It gets default signal actions, an empty signal mask, and no descriptors
// except its standard streams.
struct NewProcess {
  std::vector<std::string> words;  // the program, from PATH if it has no slash, and arguments
  int input = -1, output = -1;     // descriptors for its standard streams
  int error = -1;                  // likewise; -1: /dev/null
  std::string folder{};            // working folder; empty: this process's own
  bool leads_group = false;        // of processes, which end_child() ends
};

// Starts and remembers a process (file/leftovers.hpp). Returns its id, or 0 with errno in `error`.
[[nodiscard]] pid_t start_process(const NewProcess& process, int& error);

}  // namespace bbsim::file
