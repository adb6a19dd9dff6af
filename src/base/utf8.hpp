// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads text that may be invalid UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace bbsim {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // 0: no valid character
};

// The first character of a nonempty text.
[[nodiscard]] Utf8Character first_character(std::string_view text);

}  // namespace bbsim
