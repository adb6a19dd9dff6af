// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes foreign text safe for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace bbsim {

// Replaces everything that a terminal would act on with an escape such as \x1b: control characters
// except line breaks and tabs; bytes that are not UTF-8 (some terminals treat 0x80 to 0x9f as
// control characters); and characters that change the direction of text, which can disguise a name.
[[nodiscard]] std::string printable(std::string_view text);

// The text as one line of printable ASCII, with other bytes escaped, for a comment in a program.
[[nodiscard]] std::string printable_ascii(std::string_view text);

}  // namespace bbsim
