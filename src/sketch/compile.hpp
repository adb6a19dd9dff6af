// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sketch -> a shared library that bbsim runs as a controller.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct Job {
  std::vector<std::string> files;    // .ino, in their order
  std::vector<std::string> folders;  // of libraries
};

struct Compiled {
  std::string library;   // its bytes; empty if the sketch does not compile
  std::string messages;  // of the compiler
};

// The last bytes of a library that compile() made.
inline constexpr const char* library_mark = "bbsim sketch\n";

// The files that compile() would read of the sketch itself and of its libraries.
[[nodiscard]] std::vector<std::string> files_of(const Job& job);

// Joins the files (source.hpp), finds libraries (libraries.hpp), and compiles all of it with the
// board's sources by $CXX, or c++, or g++. Throws InputError for files that cannot be read, and
// OutputError if there is no compiler, or no board beside the program.
[[nodiscard]] Compiled compile(const Job& job);

}  // namespace bbsim::sketch
