// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Functions that templates on a number type need, for doubles. Other number types overload them.
#pragma once

#include <cmath>
#include <limits>

namespace bbsim {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// Sine and cosine together. Number types with a faster way overload sin_cos().
template <class Real>
struct SinCos {
  Real sin, cos;
};

template <class Real>
[[nodiscard]] SinCos<Real> sin_cos(const Real& angle) {
  using std::cos;
  using std::sin;
  return {sin(angle), cos(angle)};
}

// The square root of `square` with the sign of `along`. A vector's length with this sign is a
// coordinate that stays smooth when the vector passes through zero and reverses.
[[nodiscard]] inline double root_along(double square, double along) {
  return std::copysign(std::sqrt(square), along);
}

// A comparison, and a choice by its result. Types with lanes overload both lane by lane.
[[nodiscard]] inline bool exceeds(double a, double b) {
  return a > b;
}
[[nodiscard]] inline double choose(bool which, double yes, double no) {
  return which ? yes : no;
}

// The number without its derivatives, in double precision or in lanes of it.
[[nodiscard]] inline double value_of(double a) {
  return a;
}
// The largest lane.
[[nodiscard]] inline double largest_of(double a) {
  return a;
}

// The larger number, or NaN if either is NaN. std::max() may ignore a NaN.
[[nodiscard]] inline double larger(double a, double b) {
  return a > b || std::isnan(a) ? a : b;
}

// The nearest integer, the even one in a tie. The spacing of doubles at 2^52 is one, so the sum
// rounds. This avoids a call into the C library.
[[nodiscard]] inline double nearest_integer(double value) {
  if (!(std::abs(value) < 0x1p52)) return value;
  const double spaced_by_one = std::copysign(0x1p52, value);
  return std::copysign((value + spaced_by_one) - spaced_by_one, value);
}

// The time as a plain double, to choose an interval.
[[nodiscard]] inline double plain(double t) {
  return t;
}

}  // namespace bbsim
