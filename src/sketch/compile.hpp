// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiles a sketch, with the libraries whose headers it includes, to a shared library that bbsim
// runs as a controller.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct Libraries {
  std::vector<std::string> folders;  // of headers
  std::vector<std::string> sources;  // compiled with the sketch
};

// Searches for the headers `included`, and for those that these include: first in the sketch's
// folders `own`, then in each folder `given` and its src/, Name/ and Name/src/. A header X.h of the
// sketch adds X.cpp; a header of a library adds all sources of its folder. Headers in the folder
// `ours` belong to the board. All sources in the folders `whole`, and below src/ in them, are
// compiled, except copies of the board's.
[[nodiscard]] Libraries find_libraries(const std::vector<std::string>& included,
                                       const std::vector<std::string>& own,
                                       const std::vector<std::string>& given,
                                       const std::string& ours,
                                       const std::vector<std::string>& whole = {});

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

// Joins the files (source.hpp), finds libraries, and compiles both and the board's
// sources with $CXX, c++ or g++. Throws InputError for files that cannot be read, and OutputError
// if there is no compiler, or if the board's sources are missing.
[[nodiscard]] Compiled compile(const Job& job);

}  // namespace bbsim::sketch
