// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Protects existing files when a command chooses the output's name itself.
#pragma once

#include <string>
#include <string_view>

namespace bbsim::file {

// How a command recognizes a file that it may replace.
struct Likeness {
  std::string what;     // for a sentence: "a table with the header t,x,y"
  std::string start{};  // if not empty, the file begins with this and ends with a line break
  std::string mark{};   // otherwise, the first or last 4096 bytes contain this
};

// For a CSV with this header, given without its line break.
[[nodiscard]] Likeness table_with(const std::string& header);

// Throws InputError, with the remedy, if a regular file exists and does not match: the user did not
// name it, so the command must not replace it. Ignores devices and pipes, which are not replaced,
// and folders, which fail when the file is opened.
void require_like(const std::string& target, const Likeness& likeness);

// Throws InputError if a regular file exists, unless it has `content`, which may be null.
void require_new(const std::string& target, const std::string_view* content);

}  // namespace bbsim::file
