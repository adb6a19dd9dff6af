// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Foreign text for use within messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim {

// The text on one line, safe for a terminal (printable.hpp), cut off after `longest` bytes.
[[nodiscard]] std::string shown(std::string_view text, std::size_t longest = 60);

// shown() in quotation marks; "nothing" for an empty text.
[[nodiscard]] std::string quoted(std::string_view text, std::size_t longest = 60);

// The length for messages of other programs.
inline constexpr std::size_t longest_saying = 200;

// The length for text that must not be cut off, such as a file name.
inline constexpr std::size_t uncut = static_cast<std::size_t>(-1);

}  // namespace bbsim
