// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Instants that are meant to be one, each computed in its own way.
#pragma once

#include <cmath>
#include <limits>

namespace bbsim {

// Times (s) that differ by no more than this are one. "0.3" may also come as 3 * 0.1 or as 300 of
// "1 ms": a number is rounded when it is read, again with its unit, and again when it is
// multiplied, by half an epsilon at most. That is 1.5 for either of two times, and the rounding of
// a sum or difference, half of one for either, makes 4. What is added up counts with its size: of
// n * period - delay, `size` is n * period.
[[nodiscard]] inline double rounding_of(double size) {
  return 4 * std::numeric_limits<double>::epsilon() * std::abs(size);
}

}  // namespace bbsim
