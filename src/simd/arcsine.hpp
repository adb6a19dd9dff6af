// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The arcsine of a pack.
//
// Included only by kernels. It overloads the arcsine for any number type in model/control/law.hpp.
#pragma once

#include "simd/compare.hpp"

namespace bbsim::simd {

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
