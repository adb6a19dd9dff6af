// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The length of the next step of a collocation method.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace bbsim::solve {

inline constexpr double step_safety = 0.9;

// The ratio of the next step's length to the last one's. `error`: of the last step, relative to the
// tolerance. Hairer and Wanner, IV.8. Single precision is enough, and faster.
template <class Real>
[[nodiscard]] inline double step_growth(Real error, int stages, double most = 8) {
  constexpr double least = 0.1;
  if (!(error > 0)) return error == 0 ? most : least;
  const auto power = static_cast<Real>(-1.0 / (stages + 1));
  return std::clamp(step_safety * double{std::pow(error, power)}, least, most);
}

// Returns z with (z/2)^s / s! = tolerance. Over a step of 2 z radians of a sinusoid, the s-th
// Legendre coefficient has just fallen to the tolerance.
[[nodiscard]] inline double resolved(int stages, double tolerance) {
  double factorial = 1;
  for (int i = 2; i <= stages; ++i) factorial *= i;
  return 2 * std::pow(tolerance * factorial, 1.0 / stages);
}

// A step towards an instant at which a step has to end.
struct Stride {
  double length;  // s
  bool arrives;   // whether it ends at that instant
};

// The next step on an interval of `left` seconds, if the tolerance allows steps of `next` seconds.
// The last three steps have the same length, so that none is a sliver.
[[nodiscard]] inline Stride stride(double left, double next) {
  constexpr double alike = 4, sliver = 1e-3;
  const double steps = left <= next ? 1 : std::ceil(left / next * (1 - sliver));
  if (!(steps > 1)) return {left, true};
  return {steps < alike ? left / steps : next, false};
}

// Whether a step from t is lost in the rounding of t, both in s.
[[nodiscard]] inline bool is_lost(double step, double t) {
  return !(step > 4 * std::numeric_limits<double>::epsilon() * t);
}

}  // namespace bbsim::solve
