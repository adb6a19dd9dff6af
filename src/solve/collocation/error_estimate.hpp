// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The tests of a collocation step: whether the iteration for its stages has converged, and the
// error, from the decay of its accelerations' last Legendre coefficients, with one case in each
// lane. radau/collocation.hpp estimates it for a single case.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/compare.hpp"

namespace bbsim::solve {

// Changes and distances are relative to the tolerance: 1 is the error that a step may have.
struct StopTest {
  double enough;  // the distance from the limit at which the iteration may end
  double floor;   // changes below it are rounding

  BBSIM_INLINE StopTest(double within, double rtol) : enough(within), floor(30 * 2.2e-16 / rtol) {}

  // Whether the last change is below the floor, or the sum of the changes to come is small enough.
  // Each change is `contraction` times the one before, so they add up to
  // change * contraction / (1 - contraction).
  BBSIM_INLINE bool passes(double change, double contraction) const {
    return change <= floor || change * contraction <= enough * (1 - contraction);
  }
  // The same for an independent iteration in each lane.
  template <class P>
  BBSIM_INLINE typename P::Mask passes(P change, P contraction) const {
    return (change.v <= P(floor).v) |
           ((change * contraction).v <= (P(enough) * (P(1.0) - contraction)).v);
  }
};

// The last four Legendre coefficients of `count` functions with values k[j] at node j.
// legendre[j][m] is the contribution of node j to coefficient m.
template <class P, int s, int count>
struct LastCoefficients {
  P of[4][count];

  BBSIM_INLINE LastCoefficients(const double (&legendre)[s][s], const P (&k)[s][count]) {
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) {
#pragma GCC unroll 8
      for (int i = 0; i < count; ++i) of[m][i] = P(0.0);
    }
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
#pragma GCC unroll 4
      for (int m = 0; m < 4; ++m) {
        const P part(legendre[j][s - 4 + m]);
#pragma GCC unroll 8
        for (int i = 0; i < count; ++i) of[m][i] += part * k[j][i];
      }
    }
  }

  // The square of `weight` times the first coefficient left out. The square saves a root.
  BBSIM_INLINE P left_out_squared(int i, P weight) const {
    const P before = simd::larger_of(simd::size_of(of[0][i]), simd::size_of(of[1][i]));
    const P tail = simd::larger_of(simd::size_of(of[2][i]), simd::size_of(of[3][i]));
    const P fall = simd::smaller_of(P(1.0), tail / (before + P(1e-300)));
    const P weighted = tail * weight;
    return weighted * weighted * fall;
  }
};

}  // namespace bbsim::solve
