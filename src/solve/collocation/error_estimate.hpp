// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The error of a collocation step from the fall of the last Legendre coefficients of its
// accelerations, another case in each lane: as radau/step.hpp tells it of one.
//
// Included only by the kernels; see simd/pack.hpp for why all is inlined or tagged.
#pragma once

#include "simd/compare.hpp"

namespace bbsim::solve {

// The last four coefficients of some numbers, of which k[j] are those at node j; legendre[j][m] is
// what node j adds to coefficient m.
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

  // The square, so that no root is taken, of the first coefficient left out, times a weight.
  BBSIM_INLINE P left_out_squared(int i, P weight) const {
    const P before = simd::larger_of(simd::size_of(of[0][i]), simd::size_of(of[1][i]));
    const P tail = simd::larger_of(simd::size_of(of[2][i]), simd::size_of(of[3][i]));
    const P fall = simd::smaller_of(P(1.0), tail / (before + P(1e-300)));
    const P weighted = tail * weight;
    return weighted * weighted * fall;
  }
};

}  // namespace bbsim::solve
