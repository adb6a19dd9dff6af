// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts as numbers, in the form that number_text.hpp writes.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace bbsim {

// The number that the whole text is; empty for any other text, and for a number out of range.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

}  // namespace bbsim
