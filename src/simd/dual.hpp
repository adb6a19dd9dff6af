// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A number with its derivative in one direction, for the exact columns of a Jacobian.
//
// Included only by the kernels. See pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/pack.hpp"

namespace bbsim::simd {

// The range of angles in sines. With `moderate`, sines beyond 10^5 rad may be wrong. A Jacobian
// tolerates that at the cost of some steps, and it saves a branch.
enum class Angles { any, moderate };

// value + slope * epsilon, epsilon^2 = 0. The lanes hold different directions of the state, one
// column of the Jacobian per lane; or different loops, one column of each.
//
// If the compiler knows the variables' slopes (0 or 1), it drops all terms that do not depend on
// the direction. Without branches it also computes the values only once for all directions.
template <class P, Angles angles = Angles::any>
struct Dual {
  P value, slope;

  BBSIM_INLINE Dual() {}  // NOLINT(modernize-use-equals-default): uninitialised on purpose
  // NOLINTNEXTLINE(google-explicit-constructor): a constant is a number like any other
  BBSIM_INLINE Dual(double constant) : value(constant), slope(0.0) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  BBSIM_INLINE Dual(P constant) : value(constant), slope(0.0) {}
  BBSIM_INLINE Dual(P v, P s) : value(v), slope(s) {}

  BBSIM_INLINE friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  BBSIM_INLINE friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  BBSIM_INLINE friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  BBSIM_INLINE friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  BBSIM_INLINE friend Dual operator*(double a, const Dual& b) { return {a * b.value, a * b.slope}; }
  BBSIM_INLINE friend Dual operator*(int a, const Dual& b) { return {a * b.value, a * b.slope}; }
  BBSIM_INLINE friend Dual operator*(P a, const Dual& b) { return {a * b.value, a * b.slope}; }
  BBSIM_INLINE friend Dual operator*(const Dual& a, P b) { return {a.value * b, a.slope * b}; }
  BBSIM_INLINE friend Dual operator/(const Dual& a, int b) { return {a.value / b, a.slope / b}; }
  BBSIM_INLINE friend Dual root_along(const Dual& square, const Dual& along) {
    const P root = root_along(square.value, along.value);
    return {root, square.slope / (2.0 * root)};
  }
  BBSIM_INLINE friend P value_of(const Dual& a) { return a.value; }
  BBSIM_INLINE friend Dual operator/(const Dual& a, const Dual& b) {
    const P quotient = a.value / b.value;
    return {quotient, (a.slope - quotient * b.slope) / b.value};
  }
};

template <class P, Angles angles>
BBSIM_INLINE SinCos<Dual<P, angles>> sin_cos(const Dual<P, angles>& angle) {
  SinCos<P> wave;
  if constexpr (angles == Angles::moderate) {
    wave = sin_cos_of_moderate(angle.value);
  } else {
    wave = sin_cos(angle.value);
  }
  return {{wave.sin, wave.cos * angle.slope}, {wave.cos, -(wave.sin * angle.slope)}};
}

}  // namespace bbsim::simd
