// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Files that a sweep keeps beside its result until it is done.
#pragma once

#include <string>

#include "file/descriptor.hpp"

namespace bbsim::file {

struct OwnFile {
  Descriptor descriptor;  // for reading and appending
  bool created = false;   // empty, because it was not there
};

// Opens or makes a file whose name anybody may foresee, in a folder that others may write to: never
// through a link, and nothing but a regular file of one's own with no other name, so that nobody
// can have another file taken for it. Throws OutputError.
[[nodiscard]] OwnFile open_own_file(const std::string& name);

// Whether the name, now, is that of the file behind the descriptor.
[[nodiscard]] bool is_name_of(const std::string& name, int descriptor);

// Removes the name if it is.
void remove_own_file(const std::string& name, int descriptor);

// The whole of such a file, if it is there. Throws OutputError.
struct OwnText {
  std::string text;
  bool there = false;
};
[[nodiscard]] OwnText read_own_file(const std::string& name);

}  // namespace bbsim::file
