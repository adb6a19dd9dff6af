// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads UTF-8 text that may be none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace bbsim {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // 0: none begins here
};

// The character at the beginning of a text that is not empty.
[[nodiscard]] Utf8Character first_character(std::string_view text);

}  // namespace bbsim
