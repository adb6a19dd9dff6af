// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The two functions that start foreign code. Fuzz targets replace them with functions that refuse,
// because their scenarios are random.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace bbsim::controller {

// Descriptors for the standard streams of a process.
struct Streams {
  int input = -1, output = -1, error = -1;
};

// Starts a program in `folder` (empty: this one) and in its own process group, with the signals of
// a login and no descriptors but its streams. Registers it at once (file/leftovers.hpp). Looks up
// the first word on PATH if it has no slash. Returns the process id, or 0 with the error number in
// `error`.
[[nodiscard]] pid_t start_program(const std::vector<std::string>& words, const std::string& folder,
                                  const Streams& streams, int& error);

// Opens a shared library. Returns null, with the reason in `error`, if that fails.
[[nodiscard]] void* open_library(const std::string& path, std::string& error);

}  // namespace bbsim::controller
