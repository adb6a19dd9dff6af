// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Greatest value of a function that is known at many equidistant points.
#pragma once

#include <algorithm>
#include <vector>

namespace bbsim_test {

// The greatest of equidistant values and of the polynomial through the seven around it.
inline double greatest_of(const std::vector<double>& values) {
  const auto most = std::max_element(values.begin(), values.end());
  if (values.end() - most <= 3 || most - values.begin() < 3) return *most;
  const auto at = [&](double u) {  // Lagrange interpolation
    double sum = 0;
    for (int k = -3; k <= 3; ++k) {
      double factor = most[k];
      for (int other = -3; other <= 3; ++other) {
        if (other != k) factor *= (u - other) / (k - other);
      }
      sum += factor;
    }
    return sum;
  };
  double from = -1, to = 1;
  for (int i = 0; i < 60; ++i) {
    const double a = from + 0.382 * (to - from), b = from + 0.618 * (to - from);
    (at(a) < at(b) ? from : to) = at(a) < at(b) ? a : b;
  }
  return std::max(*most, at(from));
}

}  // namespace bbsim_test
