// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace bbsim {

char* write_number(char* to, double value) {
  constexpr std::string_view nan = "nan";  // without the sign that to_chars writes
  if (std::isnan(value)) return std::ranges::copy(nan, to).out;
  return std::to_chars(to, to + longest_number, value).ptr;
}

}  // namespace bbsim
