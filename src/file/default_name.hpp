// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A file under a name that the user did not give.
#pragma once

#include <string>

namespace bbsim::file {

// How a command knows a file that it may write over.
struct Likeness {
  std::string what;     // it is, in a sentence: "a table with the header t,x,y"
  std::string start{};  // what it begins with, and then it ends with a line break; or ...
  std::string mark{};   // ... what is within its first or last 4096 bytes
};

// That of a CSV with this header, which is without its line break.
[[nodiscard]] Likeness table_with(const std::string& header);

// Throws InputError, with what to do, if a regular file is there that is not like that: what a
// command would replace, and nobody named. Devices and pipes are not replaced, and of a folder the
// one that opens it says what is wrong.
void require_like(const std::string& target, const Likeness& likeness);

}  // namespace bbsim::file
