// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ball's equation for given angles of the gimbal, with one case in each lane.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/given_ball.hpp"
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

  struct Memory {
    GivenBall<P> at[s];
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
