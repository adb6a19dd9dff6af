// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text, as files contain them.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "base/number_text.hpp"
#include "catch.hpp"

using bbsim::number_text;

namespace {

// Text by the C++ standard: shortest round-trip text, the closest of those, and the shorter of
// fixed and scientific notation.
std::string standard_text(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// Counts numbers whose text differs from the standard's, and keeps the first of them.
struct Differences {
  long count = 0;
  std::string first;

  void look_at(double value) {
    const std::string text = number_text(value), expected = standard_text(value);
    if (text == expected) return;
    if (count++ == 0) first = text + " for " + expected;
  }
};

double of_bits(std::uint64_t bits) {
  return std::bit_cast<double>(bits);
}

}  // namespace

TEST_CASE("numbers are written with as few digits as round-trip, fixed or scientific") {
  CHECK(number_text(0) == "0");
  CHECK(number_text(-0.0) == "-0");
  CHECK(number_text(1) == "1");
  CHECK(number_text(-0.1) == "-0.1");
  CHECK(number_text(1.0 / 3) == "0.3333333333333333");
  CHECK(number_text(-1234.5) == "-1234.5");
  CHECK(number_text(0.001) == "0.001");  // as long as 1e-03
  CHECK(number_text(0.0001) == "1e-04");
  CHECK(number_text(0.00012) == "0.00012");
  CHECK(number_text(1e5) == "1e+05");
  CHECK(number_text(12e4) == "120000");
  CHECK(number_text(9007199254740993e4) == "90071992547409936384");  // all digits of an integer
  CHECK(number_text(std::numeric_limits<double>::denorm_min()) == "5e-324");
  CHECK(number_text(std::numeric_limits<double>::max()) == "1.7976931348623157e+308");
  CHECK(number_text(-std::numeric_limits<double>::min()) == "-2.2250738585072014e-308");
  CHECK(number_text(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(number_text(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(number_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
  CHECK(number_text(-std::numeric_limits<double>::quiet_NaN()) == "nan");
}

TEST_CASE("numbers of all sizes are written as the standard library writes them") {
  Differences differences;
  std::mt19937_64 random(1);
  for (int i = 0; i < 200'000; ++i) {
    const double any = of_bits(random());
    if (!std::isnan(any)) differences.look_at(any);
    differences.look_at(static_cast<double>(random() >> (random() % 64)));         // integers
    differences.look_at(static_cast<double>(random() >> (random() % 64)) / 1000);  // short decimals
    differences.look_at(std::ldexp(static_cast<double>(random() >> 11U), -60));    // as columns
    differences.look_at(0.01 * static_cast<double>(random() % 100'000));           // times
  }
  INFO(differences.first);
  CHECK(differences.count == 0);
}

TEST_CASE("numbers next to powers of two and of ten are written as the standard library does") {
  Differences differences;
  for (int exponent = -1074; exponent < 1024; ++exponent) {
    const auto bits = std::bit_cast<std::uint64_t>(std::ldexp(1.0, exponent));
    for (const std::uint64_t next : {bits - 1, bits, bits + 1}) {
      differences.look_at(of_bits(next));
      differences.look_at(-of_bits(next));
    }
  }
  for (int exponent = -324; exponent < 309; ++exponent) {
    for (int digits = 1; digits < 100; ++digits) {
      const std::string text = std::to_string(digits) + 'e' + std::to_string(exponent);
      differences.look_at(std::strtod(text.c_str(), nullptr));
    }
  }
  INFO(differences.first);
  CHECK(differences.count == 0);
}
