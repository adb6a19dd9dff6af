// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The largest of many numbers, none of which may be anything but one: std::max() passes over NaN.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "catch.hpp"

namespace bbsim_test {

// The largest so far and of these, which have to be finite.
inline double largest_finite(double so_far, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) FAIL("found " << number << " among numbers to be compared");
    so_far = std::max(so_far, number);
  }
  return so_far;
}

}  // namespace bbsim_test
