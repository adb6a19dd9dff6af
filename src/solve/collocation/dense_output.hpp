// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Dense output over one collocation step: Legendre series of some coordinates and their velocities,
// with one case in each lane.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/pack.hpp"

namespace bbsim::solve {

template <class P, int s, int coordinates>
struct DenseOutput {
  P k[coordinates][s], v[coordinates][s + 1], q[coordinates][s + 2];

  // Makes the series from the accelerations times h at the nodes, at(j, i), and from the
  // coordinates q0(i) and velocities v0(i) at the start. legendre[j][m] is the contribution of node
  // j to coefficient m.
  template <class At, class From, class FromRate>
  BBSIM_INLINE void make(const double (&legendre)[s][s], P h, At at, From q0, FromRate v0) {
    constexpr int together = 4;
    static_assert(s % together == 0);
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P sum[together][coordinates];
#pragma GCC unroll 4
      for (int m = 0; m < together; ++m) {
#pragma GCC unroll 8
        for (int i = 0; i < coordinates; ++i) sum[m][i] = P(0.0);
      }
#pragma GCC unroll 2
      for (int j = 0; j < s; ++j) {
#pragma GCC unroll 4
        for (int m = 0; m < together; ++m) {
          const P part(legendre[j][first + m]);
#pragma GCC unroll 8
          for (int i = 0; i < coordinates; ++i) sum[m][i] += part * at(j, i);
        }
      }
#pragma GCC unroll 4
      for (int m = 0; m < together; ++m) {
#pragma GCC unroll 8
        for (int i = 0; i < coordinates; ++i) k[i][first + m] = sum[m][i];
      }
    }
#pragma GCC unroll 8
    for (int i = 0; i < coordinates; ++i) {
      integrate<s>(k[i], P(0.5), v0(i), v[i]);
      integrate<s + 1>(v[i], P(0.5) * h, q0(i), q[i]);
    }
  }

  // `half` times the integral from -1 of a Legendre series of `length` terms, plus `from`.
  template <int length>
  BBSIM_INLINE static void integrate(const P* k, P half, P from, P* out) {
    out[0] = from + half * (k[0] - k[1] * P(1.0 / 3));
#pragma GCC unroll 1
    for (int m = 1; m <= length; ++m) {
      const P next = m + 1 < length ? k[m + 1] * P(1.0 / (2 * m + 3)) : P(0.0);
      out[m] = half * (k[m - 1] * P(1.0 / (2 * m - 1)) - next);
    }
  }

  // Calls add(m, P_m(x)) for m = 1 ... s + 1. x goes from -1 to 1 over the step.
  template <class Add>
  BBSIM_INLINE static void polynomials(P x, Add add) {
    P before(1.0), now = x;
    add(1, now);
#pragma GCC unroll 1
    for (int m = 1; m <= s; ++m) {
      // P_(m+1) = ((2 m + 1) x P_m - m P_(m-1)) / (m + 1)
      const P next =
          P((2.0 * m + 1) / (m + 1)) * x * now - rounded(P(double(m) / (m + 1)) * before);
      before = now;
      now = next;
      add(m + 1, now);
    }
  }

  // The coordinates and their velocities at `part` of the step, 0 to 1.
  BBSIM_INLINE void at(P part, P (&position)[coordinates], P (&velocity)[coordinates]) const {
#pragma GCC unroll 4
    for (int i = 0; i < coordinates; ++i) {
      position[i] = q[i][0];
      velocity[i] = v[i][0];
    }
    polynomials(
        P(2.0) * part - P(1.0), [&](int m, P value) __attribute__((always_inline)) {
          for (int i = 0; i < coordinates; ++i) {
            position[i] += q[i][m] * value;
            if (m <= s) velocity[i] += v[i][m] * value;
          }
        });
  }

  // The velocities, and the accelerations times h, at `part` of the step.
  BBSIM_INLINE void rates_at(P part, P (&velocity)[coordinates],
                             P (&acceleration)[coordinates]) const {
#pragma GCC unroll 4
    for (int i = 0; i < coordinates; ++i) {
      velocity[i] = v[i][0];
      acceleration[i] = k[i][0];
    }
    polynomials(
        P(2.0) * part - P(1.0), [&](int m, P value) __attribute__((always_inline)) {
          for (int i = 0; i < coordinates; ++i) {
            if (m <= s) velocity[i] += v[i][m] * value;
            if (m < s) acceleration[i] += k[i][m] * value;
          }
        });
  }
};

}  // namespace bbsim::solve
