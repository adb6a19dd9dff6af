// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What templates on a number type ask of it, for doubles; other types overload it.
#pragma once

#include <cmath>
#include <limits>

namespace bbsim {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// Sine and cosine together. Overloaded for number types that have a faster way.
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

// The root of `square`, with the sign of `along`: the length of a vector as a coordinate that goes
// on smoothly through zero, where the vector turns round.
[[nodiscard]] inline double root_along(double square, double along) {
  return std::copysign(std::sqrt(square), along);
}

// Whether a number exceeds another, and one of two by that: lane by lane, of a type with lanes.
[[nodiscard]] inline bool exceeds(double a, double b) {
  return a > b;
}
[[nodiscard]] inline double choose(bool which, double yes, double no) {
  return which ? yes : no;
}

// The larger of two; no number if one of them is none, which std::max() may pass over.
[[nodiscard]] inline double larger(double a, double b) {
  return a > b || std::isnan(a) ? a : b;
}

// The nearest integer, of two the even one. At 2^52 the spacing of doubles is one, so that the sum
// rounds; the C library would have to be called for it.
[[nodiscard]] inline double nearest_integer(double value) {
  if (!(std::abs(value) < 0x1p52)) return value;
  const double spaced_by_one = std::copysign(0x1p52, value);
  return std::copysign((value + spaced_by_one) - spaced_by_one, value);
}

// The time as a plain double, to choose an interval by. Overloaded for other number types.
[[nodiscard]] inline double plain(double t) {
  return t;
}

}  // namespace bbsim
