// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string_view>

#include "base/error.hpp"

namespace bbsim {

char* write_number(char* to, double value) {
  constexpr std::string_view nan = "nan";  // without the sign that to_chars writes
  if (std::isnan(value)) return std::ranges::copy(nan, to).out;
  return std::to_chars(to, to + longest_number, value).ptr;
}

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

namespace {

std::string in_unit(double value, double units, const char* unit, const char* si) {
  return std::isfinite(value * units) ? short_number(value * units) + unit
                                      : short_number(value) + si;
}

}  // namespace

std::string degrees(double angle) {
  return in_unit(angle, 180 / std::numbers::pi, " deg", " rad");
}

std::string milliseconds(double time) {
  return in_unit(time, 1e3, " ms", " s");
}

std::string millimetres(double length) {
  return in_unit(length, 1e3, " mm", " m");
}

bool is_whole(double value, double least, double most) {
  return value >= least && value <= most && value == std::floor(value);
}

std::string whole_numbers(double least, double most) {
  return "a whole number from " + short_number(least) +
         (most < largest_whole ? " to " + short_number(most) : " up, below 2^53");
}

void require_whole(const std::string& name, double value, double least, double most) {
  if (is_whole(value, least, most)) return;
  throw InputError(name + ": found " + short_number(value) +
                   "; allowed: " + whole_numbers(least, most));
}

}  // namespace bbsim
