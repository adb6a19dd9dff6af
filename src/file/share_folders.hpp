// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the files that are installed with the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bbsim::file {

// The path of the shared library that contains this code; empty if the program contains it.
[[nodiscard]] std::filesystem::path own_library();

// PREFIX/NAME/bbsim of the program, and the same with the folder's name when it was built.
[[nodiscard]] std::vector<std::string> folders_of_prefix(const char* name, const char* installed);

// The folders with this name in that of a library and above it, as many as `levels`.
[[nodiscard]] std::vector<std::string> folders_above(const std::filesystem::path& library,
                                                     int levels, const std::filesystem::path& name);

// The candidates for share/bbsim, in order; BBSIM_SHARE_PATH alone, if it is set.
[[nodiscard]] std::vector<std::string> share_folders();

// The candidates for libexec/bbsim, in order: programs that are part of this one.
[[nodiscard]] std::vector<std::string> libexec_folders();

}  // namespace bbsim::file
