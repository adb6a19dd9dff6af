// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiles a sketch to a shared library that bbsim runs as a controller.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct Job {
  std::vector<std::string> files;    // .ino, in order
  std::vector<std::string> folders;  // of libraries
};

struct Compiled {
  std::string library;   // its bytes; empty if the sketch does not compile
  std::string messages;  // of the compiler
};

// The last bytes of every library from compile().
inline constexpr const char* library_mark = "bbsim sketch\n";

// The source files of the sketch and of its libraries that compile() would use.
[[nodiscard]] std::vector<std::string> files_of(const Job& job);

// Joins the files (source.hpp), finds libraries (libraries.hpp), and compiles both and the board's
// sources with $CXX, c++ or g++. Throws InputError for files that cannot be read, and OutputError
// if there is no compiler, or if the board's sources are missing.
[[nodiscard]] Compiled compile(const Job& job);

}  // namespace bbsim::sketch
