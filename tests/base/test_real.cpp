// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Functions on numbers, under the names that packs of numbers share.
#include <cmath>

#include "base/real.hpp"
#include "catch.hpp"

namespace bbsim_test::test_real {

using namespace bbsim;

TEST_CASE("the nearest integer equals the C library's") {
  for (const double value : {0.0, 0.5, 1.5, 2.5, -0.5, -1.5, -0.3, 0.49999999999999994, 1e15 + 0.5,
                             -3e15 - 0.5, 0x1p51 - 0.5, 0x1p51, 0x1p52 + 1, 1e300}) {
    CAPTURE(value);
    CHECK(nearest_integer(value) == std::nearbyint(value));
    CHECK(std::signbit(nearest_integer(value)) == std::signbit(std::nearbyint(value)));
  }
  CHECK(std::isnan(nearest_integer(std::nan(""))));
  CHECK(std::isinf(nearest_integer(-INFINITY)));
}

}  // namespace bbsim_test::test_real
