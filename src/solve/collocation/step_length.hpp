// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The lengths of the steps of a collocation method.
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

// The steps of one run. The tolerance allows steps of `next` seconds.
struct StepControl {
  double next = std::numeric_limits<double>::infinity();
  int rejections = 0;  // since the last accepted step

  // After an attempt at `step` seconds whose error exceeds the tolerance. `growth`: step_growth()
  // of the error, or `unsolved` if there is none.
  static constexpr double unsolved = 0.4;
  void reject(double step, double growth) {
    next = step * std::min(0.8, growth);
    ++rejections;
  }

  // After an accepted step. `arrives`: whether it ends where a step has to. `most`: a bound of the
  // next step from elsewhere. A step that was cut short there says little about the next.
  void accept(double step, bool arrives, double growth,
              double most = std::numeric_limits<double>::infinity()) {
    const bool cut = arrives && rejections == 0 && step < next;
    const double grown = std::min(most, step * (rejections > 0 ? std::min(growth, 1.0) : growth));
    next = cut ? std::max(next, grown) : grown;
    rejections = 0;
  }
  // Whether accept() depends on the growth, up to a growth of 8.
  [[nodiscard]] bool needs_growth(double step, bool arrives) const {
    return !arrives || rejections > 0 || next < 8 * step;
  }
};

// Whether a step from t is lost in the rounding of t, both in s.
[[nodiscard]] inline bool is_lost(double step, double t) {
  return !(step > 4 * std::numeric_limits<double>::epsilon() * t);
}

}  // namespace bbsim::solve
