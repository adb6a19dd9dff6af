// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text: the shortest form that reads back to the same double.
#pragma once

#include <cstddef>
#include <string>

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

}  // namespace bbsim
