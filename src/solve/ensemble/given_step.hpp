// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The iteration of a step for given angles of the gimbal, with one case in each lane.
//
// The coefficients of the linear equation are computed once per step at the nodes of Radau IIA.
// Substitution solves the remaining equations:
//
//     v = v(0) + h A k,    q = q(0) + c h v(0) + h^2 A A k
//
// The iteration goes from node to node and uses new values immediately. An integral mostly depends
// on earlier nodes, so this contracts much faster than updating all nodes together: steps of some
// radians of the motion take three or four iterations.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/error_estimate.hpp"
#include "solve/collocation/given_ball.hpp"
#include "solve/collocation/node_rows.hpp"
#include "solve/ensemble/equations.hpp"
#include "solve/ensemble/workspace.hpp"

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

template <class Base>
struct GivenStep : Base {
  using Base::nq, Base::nv, Base::rows, Base::s;
  using Base::phi, Base::theta, Base::unknown, Base::unknowns, Base::with_position;
  using typename Base::Mask, typename Base::P, typename Base::Pack, typename Base::Scene,
      typename Base::Signals, typename Base::Workspace;

  // Sets the gimbal's angles, rates and accelerations at the start and the nodes.
  [[gnu::noinline, gnu::flatten]] static void take_angles(const Workspace& w, int p, Pack& of) {
    const Scene scene = Base::scene(w, p);
    const P from = Base::from(w, p), h = Base::length(w, p);
    const bool moderate = scene.moderate_until(from + h);
    const auto at = [&](int node) __attribute__((always_inline)) {
      return node < 0 ? from : from + P(rows.c[node]) * h;
    };
#pragma GCC unroll 1
    for (int j = -1; j < s; ++j) {
      const Signals to = moderate ? scene.template signals<true>(at(j)) : scene.signals(at(j));
      for (int i = 0; i < 2; ++i) {
        (j < 0 ? of.q : of.q_at[j])[phi + i] = to[i].value;
        (j < 0 ? of.v : of.v_at[j])[phi + i] = to[i].rate;
        (j < 0 ? of.k_end : of.k[j])[phi + i] = to[i].acceleration;
      }
    }
    for (std::size_t n = 0; n < w.shared.terms.table_count; ++n) {
      const model::Tabulated& table = w.shared.terms.tables[n];
      const auto i = phi + table.component;
      const auto piece = Base::piece_at(table.spline, from + P(0.5) * h);
#pragma GCC unroll 1
      for (int j = -1; j < s; ++j) {
        const model::Jet<P> jet = piece.at(at(j));
        (j < 0 ? of.q : of.q_at[j])[i] += jet.value;
        (j < 0 ? of.v : of.v_at[j])[i] += jet.rate;
        (j < 0 ? of.k_end : of.k[j])[i] += jet.acceleration;
      }
    }
  }

  template <bool small>
  [[gnu::noinline, gnu::flatten]] static void take_coefficients(const Workspace& w, int p,
                                                                Pack& of) {
    const Scene scene = Base::scene(w, p);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const SinCos<P> first = Base::template direction<small>(of.q_at[j][phi]);
      const SinCos<P> second = Base::template direction<small>(of.q_at[j][theta]);
      of.method.at[j].template take<true>(
          {first.sin, first.cos, of.v_at[j][phi], of.k[j][phi]},
          {second.sin, second.cos, of.v_at[j][theta], of.k[j][theta]}, nullptr, scene.radius,
          scene.gravity, P(1.0));
    }
  }

  // Goes once through the nodes. Returns the greatest changes of the accelerations. Lanes that are
  // not active keep their numbers. `all`: whether all lanes are active.
  template <bool all>
  BBSIM_INLINE static void improve(Pack& of, P h, Mask active, P (&change)[unknowns]) {
    constexpr int together = 2;
    static_assert(s % together == 0);
    for (P& greatest : change) greatest = P(0.0);
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P q[together][with_position], v[together][unknowns];
      // The newest values are added last, so that no sum waits for them.
      Base::template integrate<together>(of, h, first, first, q, v);
#pragma GCC unroll 2
      for (int n = 0; n < together; ++n) {
        const int j = first + n;
        P k[unknowns];
#pragma GCC unroll 3
        for (int i = 0; i < unknowns; ++i) k[i] = of.method.at[j].at(i, q[n], v[n]);
#pragma GCC unroll 3
        for (int i = 0; i < unknowns; ++i) {
          const int to = unknown[i];
          if (!all) {
            k[i] = choose(active, k[i], of.k[j][to]);
            v[n][i] = choose(active, v[n][i], of.v_at[j][to]);
            if (i < with_position) q[n][i] = choose(active, q[n][i], of.q_at[j][to]);
          }
          change[i] = larger_of(change[i], size_of(k[i] - of.k[j][to]));
          of.k[j][to] = k[i];
          of.v_at[j][to] = v[n][i];
          if (i < with_position) of.q_at[j][to] = q[n][i];
        }
      }
    }
  }

  // The weight of a change of an acceleration, from the largest states.
  BBSIM_INLINE static P weight(const Pack& of, P h) {
    P by_v = of.v_weight[unknown[0]], by_q = of.q_weight[unknown[0]];
#pragma GCC unroll 3
    for (int i = 1; i < unknowns; ++i) {
      by_v = smaller_of(by_v, of.v_weight[unknown[i]]);
      if (i < with_position) by_q = smaller_of(by_q, of.q_weight[unknown[i]]);
    }
    return h * larger_of(by_v, h * by_q);
  }

  static constexpr int most_turns = 15;

  // Solves one pack. Returns which lanes converged. A lane that has converged, or will not, takes
  // no part in further iterations.
  [[gnu::flatten]] static Mask solve(Workspace& w, int p, int& turns) {
    Pack& of = w.of[p];
    const Scene scene = Base::scene(w, p);
    const P h = Base::length(w, p);
    take_angles(w, p, of);
    Base::are_small(of) ? take_coefficients<true>(w, p, of) : take_coefficients<false>(w, p, of);
    // First guess: the ball keeps its velocity.
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const P time = P(rows.c[j]) * h;
      const P q[2] = {of.q[0] + time * of.v[0], of.q[1] + time * of.v[1]};
      const P v[3] = {of.v[unknown[0]], of.v[unknown[1]], of.v[unknown[2]]};
      for (int i = 0; i < unknowns; ++i) of.k[j][unknown[i]] = of.method.at[j].at(i, q, v);
    }
    constexpr double slow = 0.5;
    const StopTest stop(1e-2, w.shared.rtol);
    P last(0.0), by_size(0.0);
    Mask resting{}, active = ~Mask{};
    for (turns = 1;; ++turns) {
      P change[unknowns];
      simd::all_of<P>(active) ? improve<true>(of, h, active, change)
                              : improve<false>(of, h, active, change);
      if (turns == 1) {
        Base::weigh(w, scene, of);
        by_size = weight(of, h);
      }
      const P now = larger_of(larger_of(change[0], change[1]), change[2]) * by_size;
      // A lane that is not finite stops here; estimate() tests its states.
      const P contraction = turns > 1 ? P::of(now.v / last.v) : P(1.0);
      const Mask rests = stop.passes(now, contraction) | ~is_finite(now);
      resting |= active & rests;
      active &= ~rests;
      if (turns > 3) active &= ~(Mask)(now.v > (P(slow) * last).v);
      if (!simd::any_of<P>(active) || turns >= most_turns) break;
      last = now;
    }
    P q[1][with_position], v[1][unknowns];
    Base::template integrate<1>(of, h, s - 1, s - 1, q, v);
    for (int i = 0; i < unknowns; ++i) {
      of.v_at[s - 1][unknown[i]] = v[0][i];
      if (i < with_position) of.q_at[s - 1][unknown[i]] = q[0][i];
    }
    return resting;
  }

  // The fastest rate at which the gimbal's action on the ball changes, 1/s. The action has
  // sinusoids and, for large angles, sinusoids of these.
  [[gnu::flatten]] static void rates(const void* workspace, double* rates) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int p = 0; p < Base::packs; ++p) {
      const Scene scene = Base::scene(w, p);
      P rate = size_of(scene.rate[0]) + size_of(scene.rate[1]), fastest(0.0);
      for (int k = 0; k < scene.harmonic_count; ++k) {
        const auto& of = scene.harmonics[k];
        const P frequency = size_of(of.frequency);
        fastest = larger_of(fastest, frequency);
        for (int i = 0; i < 2; ++i) {
          const P squared = of.sine[i] * of.sine[i] + of.cosine[i] * of.cosine[i];
          rate += frequency * simd::root_of(squared);
        }
      }
      (fastest + rate).store(rates + p * Base::lanes);
    }
  }

  // The gimbal's angles at a time within a step.
  BBSIM_INLINE static Signals angles_at(const Workspace& w, int p, const Scene& scene, P t) {
    Signals at = scene.signals(t);
    const P middle = Base::from(w, p) + P(0.5) * Base::length(w, p);
    for (std::size_t n = 0; n < w.shared.terms.table_count; ++n) {
      const model::Tabulated& table = w.shared.terms.tables[n];
      const model::Jet<P> jet = Base::piece_at(table.spline, middle).at(t);
      model::Jet<P>& sum = at[table.component];
      sum.value += jet.value;
      sum.rate += jet.rate;
      sum.acceleration += jet.acceleration;
    }
    return at;
  }
};

}  // namespace bbsim::solve::ensemble
