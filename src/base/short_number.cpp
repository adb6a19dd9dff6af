// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/short_number.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace bbsim {

std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  if (!(std::abs(value) >= 1 && std::abs(value) < 1e15)) return text;
  const double kept = std::strtod(text, nullptr);
  const int before_point = static_cast<int>(std::log10(std::abs(kept))) + 1;
  std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - before_point), kept);
  return text;
}

}  // namespace bbsim
