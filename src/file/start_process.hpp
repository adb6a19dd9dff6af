// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Starts processes, and runs programs to their end. No other code does.
#pragma once

#include <sys/types.h>

#include <optional>
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

struct Finished {
  int status = 0;  // from waitpid()
  std::string output, complaint;
  [[nodiscard]] bool well() const;  // it exited with code 0
};

// Runs the program words[0], from the PATH, with `input` as its standard input. Returns nothing if
// the program does not exist. Throws OutputError: "cannot `purpose`: why".
[[nodiscard]] std::optional<Finished> run_program(const std::vector<std::string>& words,
                                                  const std::string& input,
                                                  const std::string& purpose);

}  // namespace bbsim::file
