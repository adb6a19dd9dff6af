// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ball's equation for given angles of the gimbal, with one case in each lane. Equation (27) is
// then linear in the ball's five states:
//
//     k = f + A (x, y, x', y', u)
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/affine.hpp"
#include "solve/collocation/node_rows.hpp"
#include "solve/ensemble/equations.hpp"

namespace bbsim::solve::ensemble {

template <class Isa, int nodes>
struct Linear : Equations<Isa, Actuation::given> {
  using Base = Equations<Isa, Actuation::given>;
  using Base::nq, Base::nv, Base::x, Base::y, Base::phi, Base::theta, Base::spin;
  using typename Base::P, typename Base::Signals;
  static constexpr int s = nodes;
  // The velocities whose accelerations are unknown, and how many of them have a position.
  static constexpr int unknown[] = {x, y, spin};
  static constexpr int with_position = 2;
  static constexpr NodeRows<Isa, s> rows{};

  // The coefficients at a node. x'' does not depend on x', y'' not on y', and u' not on x, y or u.
  struct Coefficients {
    P value[3], x_by[4], y_by[4], u_by[2];

    BBSIM_INLINE void take(const typename Base::Scene& scene, const model::GimbalAngle<P>& first,
                           const model::GimbalAngle<P>& second) {
      using Ball = simd::Affine<P, 5>;
      const model::RollingState<Ball, Ball, Ball> ball{Ball::variable(0), Ball::variable(1),
                                                       Ball::variable(2), Ball::variable(3),
                                                       Ball::variable(4)};
      const Ball of_x =
          model::x_acceleration<Ball>(first, second, ball, scene.radius, scene.gravity);
      const Ball of_y =
          model::y_acceleration<Ball>(first, second, ball, scene.radius, scene.gravity);
      const Ball of_u = model::u_acceleration<Ball>(first, second, ball, scene.radius);
      value[0] = of_x.value, value[1] = of_y.value, value[2] = of_u.value;
      x_by[0] = of_x.by[0], x_by[1] = of_x.by[1], x_by[2] = of_x.by[3], x_by[3] = of_x.by[4];
      y_by[0] = of_y.by[0], y_by[1] = of_y.by[1], y_by[2] = of_y.by[2], y_by[3] = of_y.by[4];
      u_by[0] = of_u.by[2], u_by[1] = of_u.by[3];
    }
    // The unknown accelerations at a state.
    BBSIM_INLINE void at(const P (&q)[2], const P (&v)[3], P (&k)[3]) const {
      k[0] = (value[0] + x_by[0] * q[0] + x_by[1] * q[1]) + (x_by[2] * v[1] + x_by[3] * v[2]);
      k[1] = (value[1] + y_by[0] * q[0] + y_by[1] * q[1]) + (y_by[2] * v[0] + y_by[3] * v[2]);
      k[2] = value[2] + u_by[0] * v[0] + u_by[1] * v[1];
    }
  };
  struct Memory {
    Coefficients at[s];
  };

  // The piece of a table at each lane's time. The type of the time keeps compilers from sharing the
  // search with other instruction sets.
  BBSIM_INLINE static model::SplinePiece<P> piece_at(const model::SplineView& table, P t) {
    model::SplinePiece<P> piece;
    for (int l = 0; l < Base::lanes; ++l) {
      const model::SplinePiece<double>& of = table.pieces[table.interval(P(t[l]))];
      piece.start.v[l] = of.start;
      piece.c0.v[l] = of.c0, piece.c1.v[l] = of.c1, piece.c2.v[l] = of.c2;
      piece.c3.v[l] = of.c3, piece.c4.v[l] = of.c4, piece.c5.v[l] = of.c5;
    }
    return piece;
  }
};

}  // namespace bbsim::solve::ensemble
