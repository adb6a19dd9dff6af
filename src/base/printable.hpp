// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Text that others wrote, on its way to a terminal.
#pragma once

#include <string>
#include <string_view>

namespace bbsim {

// The text with all that a terminal would act on instead of showing it written as escapes, such as
// \x1b: control characters but for line breaks and tabs, bytes that are no UTF-8 (some terminals
// take those from 0x80 to 0x9f for control characters), and the characters that turn the direction
// of what follows, which can make a name look like another. All else stays as it is.
[[nodiscard]] std::string printable(std::string_view text);

// The text in one line of printable ASCII, all other bytes as escapes: for a comment in a program.
[[nodiscard]] std::string printable_ascii(std::string_view text);

}  // namespace bbsim
