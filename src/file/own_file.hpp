// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Opens working files that a sweep keeps beside its result until it is done.
#pragma once

#include <string>

#include "file/descriptor.hpp"

namespace bbsim::file {

// Opens, for reading and appending, or creates a file with a predictable name in a folder that
// others may write to. Refuses links and everything but a regular file of this user with no other
// name, so that an attacker cannot substitute another file. Throws OutputError.
[[nodiscard]] Descriptor open_own_file(const std::string& name);

// Whether the name now refers to the file behind the descriptor.
[[nodiscard]] bool is_name_of(const std::string& name, int descriptor);

// Removes the name if it refers to the file behind the descriptor.
void remove_own_file(const std::string& name, int descriptor);

// Opens such a file for reading; a closed descriptor if it does not exist.
[[nodiscard]] Descriptor find_own_file(const std::string& name);

}  // namespace bbsim::file
