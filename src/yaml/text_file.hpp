// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scenario file, a pipe or a device -> bytes.
#pragma once

#include <cstddef>
#include <string>

namespace bbsim::yaml {

inline constexpr std::size_t largest_text = 1048576;  // bytes, 1 MiB

// Reads a file, a pipe or a device, but never more than largest_text bytes, and never waits longer
// than five seconds for the next ones. "-" is standard input, where somebody may be typing: that is
// waited for. Throws InputError: "file: found ...; allowed: ...".
[[nodiscard]] std::string read_text(const std::string& file);

// What the file is called in messages.
[[nodiscard]] std::string name_in_messages(const std::string& file);

}  // namespace bbsim::yaml
