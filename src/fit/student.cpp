// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/student.hpp"

#include <cmath>
#include <numbers>

namespace bbsim::fit {
namespace {

// Integral of cos^(n - 1) from 0 to `angle` by Simpson's rule: with t = sqrt(n) tan(angle), the
// distribution up to a factor.
double part(double n, double angle) {
  constexpr int intervals = 2000;
  const double h = angle / intervals;
  double sum = 0;
  for (int i = 0; i <= intervals; ++i) {
    const int weight = i == 0 || i == intervals ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * std::pow(std::cos(i * h), n - 1);
  }
  return sum * h / 3;
}

}  // namespace

double student_95(double degrees_of_freedom) {
  constexpr double normal = 1.959963984540054;
  const double n = degrees_of_freedom;
  // The Cornish-Fisher expansion is accurate to 1e-9 there.
  if (n > 500) {
    const double z = normal, z3 = z * z * z, z5 = z3 * z * z;
    return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n);
  }
  const double whole =
      std::sqrt(std::numbers::pi) / 2 * std::exp(std::lgamma(n / 2) - std::lgamma((n + 1) / 2));
  double low = 0, high = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (part(n, middle) < 0.95 * whole ? low : high) = middle;
  }
  return std::sqrt(n) * std::tan((low + high) / 2);
}

}  // namespace bbsim::fit
