// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ball's equation on a plate whose motion is given. It is then linear in the ball's five
// states: k = f + A (x, y, x', y', u).
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "model/systems/system.hpp"
#include "simd/affine.hpp"

namespace bbsim::solve {

template <class P>
struct GivenBall {
  // Which of x, y, x', y', u the accelerations x'', y'' and u' depend on, in (27) and in (M18) to
  // (M20).
  static constexpr bool depends[3][5] = {{true, true, false, true, true},
                                         {true, true, true, false, true},
                                         {false, false, true, true, false}};
  P value[3], by[3][5];

  // The coefficients times h. `papers`: for the paper's plate, whatever the rolling.
  template <bool papers, class Rolling, class Number>
  BBSIM_INLINE void take(const model::GimbalAngle<P>& phi, const model::GimbalAngle<P>& theta,
                         const Rolling& rolling, const Number& r, const Number& g, const P& h) {
    using Ball = simd::Affine<P, 5>;
    const model::RollingState<Ball, Ball, Ball> ball{Ball::variable(0), Ball::variable(1),
                                                     Ball::variable(2), Ball::variable(3),
                                                     Ball::variable(4)};
    Ball of[3];
    if constexpr (papers) {
      of[0] = model::Equation27::x<Ball>(phi, theta, ball, P(r), P(g));
      of[1] = model::Equation27::y<Ball>(phi, theta, ball, P(r), P(g));
      of[2] = model::Equation27::u<Ball>(phi, theta, ball, P(r));
    } else {
      const auto all = rolling.template rates<Ball>(phi, theta, ball, r, g);
      of[0] = all.x;
      of[1] = all.y;
      of[2] = all.u;
    }
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      value[i] = h * of[i].value;
#pragma GCC unroll 5
      for (int s = 0; s < 5; ++s) {
        if (depends[i][s]) by[i][s] = h * of[i].by[s];
      }
    }
  }

  // Acceleration i at (x, y) and (x', y', u). Two sums make shorter chains of dependent additions.
  BBSIM_INLINE P at(int i, const P (&q)[2], const P (&v)[3]) const {
    P sum = value[i];
#pragma GCC unroll 2
    for (int s = 0; s < 2; ++s) {
      if (depends[i][s]) sum += by[i][s] * q[s];
    }
    const int first = depends[i][2] ? 0 : 1, second = depends[i][4] ? 2 : 1;
    return sum + (by[i][2 + first] * v[first] + by[i][2 + second] * v[second]);
  }
};

}  // namespace bbsim::solve
