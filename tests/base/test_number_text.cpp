// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text, as files contain them.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

#include "base/number_text.hpp"
#include "catch.hpp"

namespace bbsim_test::test_number_text {

using bbsim::number_text;

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

TEST_CASE("numbers of all sizes are read back to the bit") {
  std::mt19937_64 random(1);
  long different = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto value = std::bit_cast<double>(random());
    const double read = std::strtod(number_text(value).c_str(), nullptr);
    if (!std::isnan(value) &&
        std::bit_cast<std::uint64_t>(read) != std::bit_cast<std::uint64_t>(value))
      ++different;
  }
  CHECK(different == 0);
}

}  // namespace bbsim_test::test_number_text
