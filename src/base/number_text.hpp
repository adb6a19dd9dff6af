// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text, exactly or short for people, and texts as numbers; and numbers without a
// fraction, from options, scenarios and callers of the API.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace bbsim {

// The longest shortest form of a double: "-2.2250738585072014e-308".
inline constexpr std::size_t longest_number = 24;

// Writes `value` at `to`, which has room for longest_number characters, and returns the end of the
// text. Every NaN becomes "nan"; infinities become "inf" and "-inf".
char* write_number(char* to, double value);

inline std::string number_text(double value) {
  char text[longest_number];
  return {text, write_number(text, value)};
}

// The number that the whole text is; empty for any other text, and for a number out of range.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

// The number with up to six significant digits.
[[nodiscard]] std::string short_number(double value);

// The number with `digits` digits; from 1 to 1e15 without an exponent: 12.3, 1230000.
[[nodiscard]] std::string rounded(double value, int digits);

// A short number in the smaller unit, unless that overflows.
[[nodiscard]] std::string degrees(double angle);       // of rad
[[nodiscard]] std::string milliseconds(double time);   // of s
[[nodiscard]] std::string millimetres(double length);  // of m

// 2^53 - 1: no other whole number reads as the same double.
inline constexpr double largest_whole = 9007199254740991.0;

// Also false for NaN.
[[nodiscard]] bool is_whole(double value, double least, double most = largest_whole);

// "a whole number from 1 up", "a whole number from 1 to 1024"
[[nodiscard]] std::string whole_numbers(double least, double most = largest_whole);

// Throws InputError with the name of the number.
void require_whole(const std::string& name, double value, double least,
                   double most = largest_whole);

}  // namespace bbsim
