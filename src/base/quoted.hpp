// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Foreign text made safe for terminals, messages and shells.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim {

// Replaces everything that a terminal would act on with an escape such as \x1b: control characters
// except line breaks and tabs; bytes that are not UTF-8 (some terminals treat 0x80 to 0x9f as
// control characters); and characters that change the direction of text, which can disguise a name.
[[nodiscard]] std::string printable(std::string_view text);

// The text as one line of printable ASCII, with other bytes escaped, for a comment in a program.
[[nodiscard]] std::string printable_ascii(std::string_view text);

// The text on one line, safe for a terminal (printable()), cut off after `longest` bytes.
[[nodiscard]] std::string shown(std::string_view text, std::size_t longest = 60);

// shown() in quotation marks; "nothing" for an empty text.
[[nodiscard]] std::string quoted(std::string_view text, std::size_t longest = 60);

// The length for messages of other programs.
inline constexpr std::size_t longest_saying = 200;

// The length for text that must not be cut off, such as a file name.
inline constexpr std::size_t uncut = static_cast<std::size_t>(-1);

// The text as one word, in single quotes if it needs them.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace bbsim
