// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The one way to start a process.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace bbsim::file {

// What a process begins with, beside all signals as at a login. It has no descriptors but its
// standard streams.
struct NewProcess {
  std::vector<std::string> words;  // the first is looked for on PATH if it has no slash
  int input = -1, output = -1;     // its standard streams: descriptors of ours
  int error = -1;                  // -1: what it says there is lost
  std::string folder{};            // that it runs in; empty: this one
  // NAME=VALUE in its environment (new_mark()). One that has a mark leads a process group, and what
  // it starts and leaves behind comes to this process.
  std::string mark{};
};

// Starts and remembers it (file/children.hpp). Its id; or 0, and why in `error`, an errno.
[[nodiscard]] pid_t start_process(const NewProcess& process, int& error);

}  // namespace bbsim::file
