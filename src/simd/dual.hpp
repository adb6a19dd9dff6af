// A number with its derivative in one direction, for the exact columns of a Jacobian.
//
// Included only by the kernels; see collocation/pack.hpp for why all is inlined or tagged.
#pragma once

#include "simd/pack.hpp"

namespace bbsim::simd {

// value + slope * epsilon, epsilon^2 = 0. The compiler, which knows the slopes of the variables, 0
// or 1, drops what does not depend on the direction (CMakeLists.txt lets it), and computes the
// values once for all directions: there are no branches here, sines included.
template <class P>
struct Partial {
  P value, slope;

  BBSIM_INLINE Partial() {}  // NOLINT(modernize-use-equals-default): uninitialised on purpose
  // NOLINTNEXTLINE(google-explicit-constructor): a constant is a number like any other
  BBSIM_INLINE Partial(double constant) : value(constant), slope(0.0) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  BBSIM_INLINE Partial(P constant) : value(constant), slope(0.0) {}
  BBSIM_INLINE Partial(P v, P s) : value(v), slope(s) {}

  BBSIM_INLINE friend Partial operator+(const Partial& a, const Partial& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  BBSIM_INLINE friend Partial operator-(const Partial& a, const Partial& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  BBSIM_INLINE friend Partial operator-(const Partial& a) { return {-a.value, -a.slope}; }
  BBSIM_INLINE friend Partial operator*(const Partial& a, const Partial& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  BBSIM_INLINE friend Partial operator*(double a, const Partial& b) {
    return {a * b.value, a * b.slope};
  }
  BBSIM_INLINE friend Partial operator*(int a, const Partial& b) {
    return {a * b.value, a * b.slope};
  }
  BBSIM_INLINE friend Partial operator*(P a, const Partial& b) {
    return {a * b.value, a * b.slope};
  }
  BBSIM_INLINE friend Partial operator*(const Partial& a, P b) { return b * a; }
  BBSIM_INLINE friend Partial operator/(const Partial& a, int b) {
    return {a.value / b, a.slope / b};
  }
};

// A Jacobian beyond angles of 10^5 may be off: it costs steps, not accuracy.
template <class P>
BBSIM_INLINE SinCos<Partial<P>> sin_cos(const Partial<P>& angle) {
  const SinCos<P> wave = sin_cos_of_moderate(angle.value);
  return {{wave.sin, wave.cos * angle.slope}, {wave.cos, -(wave.sin * angle.slope)}};
}

}  // namespace bbsim::simd
