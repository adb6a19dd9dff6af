// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The largest of many numbers, all of which must be numbers: std::max() ignores NaN.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "catch.hpp"

namespace bbsim_test {

// The larger of `so_far` and these numbers, which must be finite.
inline double largest_finite(double so_far, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) FAIL("found " << number << " among numbers to be compared");
    so_far = std::max(so_far, number);
  }
  return so_far;
}

}  // namespace bbsim_test
