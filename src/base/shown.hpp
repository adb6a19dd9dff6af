// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A piece of text that others wrote, within a sentence of ours.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim {

// The text on one line, fit for a terminal (printable.hpp), and cut off after that many bytes.
[[nodiscard]] std::string shown(std::string_view text, std::size_t longest = 60);

// The text shown so in quotation marks; "nothing" for an empty one.
[[nodiscard]] std::string quoted(std::string_view text, std::size_t longest = 60);

// The length for what another program said.
inline constexpr std::size_t longest_saying = 200;

// The length for what is never cut off, such as the name of a file.
inline constexpr std::size_t uncut = static_cast<std::size_t>(-1);

}  // namespace bbsim
