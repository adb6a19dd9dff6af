// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads a scenario file, a pipe or a device.
#pragma once

#include <cstddef>
#include <string>

namespace bbsim::yaml {

inline constexpr std::size_t largest_text = 1048576;  // bytes, 1 MiB

// Reads at most largest_text bytes. Waits at most five seconds for each piece of data. "-" means
// standard input, where a user may type: this waits without limit. Throws InputError with "file:
// found ...; allowed: ...".
[[nodiscard]] std::string read_text(const std::string& file);

// The file's name in messages.
[[nodiscard]] std::string name_in_messages(const std::string& file);

}  // namespace bbsim::yaml
