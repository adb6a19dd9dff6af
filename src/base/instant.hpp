// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The tolerance for comparing instants that were computed in different ways.
#pragma once

#include <cmath>
#include <limits>

namespace bbsim {

// Times (s) that differ by no more than this are the same instant. "0.3" may also come as 3 * 0.1
// or as 300 of "1 ms". Each rounding adds at most half an epsilon: the number is rounded when it is
// read, again with its unit, and again when it is multiplied. That is 1.5 for each of the two
// times. The rounding of a sum or difference adds a half for each, so the total is 4. `size` is the
// largest term: for n * period - delay it is n * period.
[[nodiscard]] inline double rounding_of(double size) {
  return 4 * std::numeric_limits<double>::epsilon() * std::abs(size);
}

}  // namespace bbsim
