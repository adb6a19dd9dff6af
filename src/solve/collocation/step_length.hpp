// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How long the next step of a collocation method may be.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace bbsim::solve {

inline constexpr double step_safety = 0.9;

// The length of the next step relative to one of `stages` stages whose error was `error`, in the
// weights of the tolerance: Hairer and Wanner, IV.8. Single precision is enough, and faster.
template <class Real>
[[nodiscard]] inline double step_growth(Real error, int stages, double most = 8) {
  constexpr double least = 0.1;
  if (!(error > 0)) return error == 0 ? most : least;
  const auto power = static_cast<Real>(-1.0 / (stages + 1));
  return std::clamp(step_safety * double{std::pow(error, power)}, least, most);
}

// A step on the way to an instant that some step has to end at.
struct Stride {
  double length;  // s
  bool arrives;   // ends at that instant
};

// The next stride over the `left` seconds until then, where the tolerance allows steps of `next`
// seconds. The last four steps are of one length, so that none is a sliver.
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
