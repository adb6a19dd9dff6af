// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The two places at which code of others begins to run. Fuzz targets, which read scenarios that
// nobody wrote, have their own of these, which refuse.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace bbsim::controller {

// What a process begins with, beside its words: descriptors for its standard streams, the folder
// that it runs in (empty: this one).
struct Streams {
  int input = -1, output = -1, error = -1;
};

// Starts a program in a process group of its own, with all signals as at a login, a mark in its
// environment (file/children.hpp) and no descriptors but its streams; it is remembered at once. The
// first word is looked for on PATH if it has no slash. Returns its id; or 0, and why in `error`.
[[nodiscard]] pid_t start_program(const std::vector<std::string>& words, const std::string& folder,
                                  const Streams& streams, const std::string& mark, int& error);

// Opens a shared library; a null pointer, and why in `error`, if it cannot be.
[[nodiscard]] void* open_library(const std::string& path, std::string& error);

}  // namespace bbsim::controller
