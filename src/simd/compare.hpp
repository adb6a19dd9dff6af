// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Comparisons and roots of packs, lane by lane: which is larger, which is finite. The same
// functions exist for single numbers.
//
// Included only by the kernels, as pack.hpp is. Most of these are compiled as if all numbers were
// finite, so is_finite() tests bits.
#pragma once

#include <type_traits>

#include "simd/pack.hpp"

namespace bbsim::simd {

template <class P>
BBSIM_INLINE P choose(typename P::Mask mask, P yes, P no) {
  return P::of(mask ? yes.v : no.v);
}
BBSIM_INLINE double choose(bool condition, double yes, double no) {
  return condition ? yes : no;
}

template <class P>
BBSIM_INLINE typename P::Mask exceeds(P a, P b) {
  return a.v > b.v;
}
BBSIM_INLINE bool exceeds(double a, double b) {
  return a > b;
}

template <class P>
BBSIM_INLINE P larger_of(P a, P b) {
  return P::of(a.v > b.v ? a.v : b.v);
}
BBSIM_INLINE double larger_of(double a, double b) {
  return a > b ? a : b;
}

template <class P>
BBSIM_INLINE P smaller_of(P a, P b) {
  return P::of(a.v < b.v ? a.v : b.v);
}
BBSIM_INLINE double smaller_of(double a, double b) {
  return a < b ? a : b;
}

template <class P>
BBSIM_INLINE P size_of(P a) {
  const typename P::Mask sign_bit = (1LL << 63) - typename P::Mask{};
  return P::of((typename P::Vector)((typename P::Mask)a.v & ~sign_bit));
}
BBSIM_INLINE double size_of(double a) {
  return __builtin_fabs(a);
}

// Like the function for doubles (base/real.hpp), except for the sign of a zero.
template <class P>
BBSIM_INLINE P nearest_integer(P a) {
  const P spaced_by_one = choose(exceeds(P(0.0), a), P(-0x1p52), P(0x1p52));
  return choose(exceeds(P(0x1p52), size_of(a)), (a + spaced_by_one) - spaced_by_one, a);
}

template <class P>
BBSIM_INLINE typename P::Mask is_finite(P a) {
  const typename P::Mask exponent = (0x7ffLL << 52) - typename P::Mask{};
  return ((typename P::Mask)a.v & exponent) != exponent;
}
BBSIM_INLINE bool is_finite(double a) {
  return (__builtin_bit_cast(unsigned long long, a) >> 52 & 0x7ff) != 0x7ff;
}

template <class P>
BBSIM_INLINE P root_of(P a) {
  for (int l = 0; l < P::size; ++l) a.v[l] = __builtin_sqrt(a.v[l]);
  return a;
}
BBSIM_INLINE double root_of(double a) {
  return __builtin_sqrt(a);
}

// The largest lane.
template <class P>
BBSIM_INLINE double largest_of(P a) {
  double most = a[0];
  for (int l = 1; l < P::size; ++l) most = larger_of(a[l], most);
  return most;
}

// Whether any lane is set. Narrowing the lanes first leaves fewer to test.
template <class P>
BBSIM_INLINE bool any_of(typename P::Mask mask) {
  if constexpr (P::size == 2) {
    return (mask[0] | mask[1]) != 0;
  } else {
    typedef std::conditional_t<P::size == 4, int, short> Narrow
        __attribute__((vector_size(16), aligned(16)));
    const auto halves = (typename Vectors<2>::Mask) __builtin_convertvector(mask, Narrow);
    return (halves[0] | halves[1]) != 0;
  }
}

template <class P>
BBSIM_INLINE bool all_of(typename P::Mask mask) {
  long long every = mask[0];
  for (int l = 1; l < P::size; ++l) every &= mask[l];
  return every != 0;
}

// Uses Newton's iteration for |s| below 0.7, and the C library beyond. A lane's result does not
// depend on the other lanes.
template <class Isa, int lanes>
BBSIM_INLINE Pack<Isa, lanes> arcsine(Pack<Isa, lanes> s) {
  using P = Pack<Isa, lanes>;
  const typename P::Mask small = exceeds(P(0.7), size_of(s));
  const P s2 = s * s;
  P angle = s * (P(1.0) + s2 * (P(1.0 / 6) +
                                s2 * (P(3.0 / 40) + s2 * (P(15.0 / 336) + s2 * P(35.0 / 1152)))));
  // The error after a step is below the square of the step.
  typename P::Mask open = small;
  for (int i = 0; i < 6 && any_of<P>(open); ++i) {
    const SinCos<P> at = sin_cos_of_small(angle);
    const P step = (at.sin - s) / at.cos;
    angle = choose(open, angle - step, angle);
    open &= ~exceeds(P(1e-8), size_of(step));
  }
  if (all_of<P>(small)) return angle;
  for (int l = 0; l < lanes; ++l) {
    if (small[l] == 0) angle.v[l] = __builtin_asin(s.v[l]);
  }
  return angle;
}

}  // namespace bbsim::simd
