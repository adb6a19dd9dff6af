// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The iteration of a step of closed loops, with one loop in each lane.
//
// The unknowns are the accelerations k at the nodes of Radau IIA,
//
//     v = v(0) + h A k,    q = q(0) + c h v(0) + h^2 A A k,    k = f(t, q, v, k),
//
// and Newton's iteration corrects them:
//
//     (I - Jk - h A (x) Jv - h^2 A A (x) Jq) dk = f - k.
//
// The eigenvectors of A split this into a complex system for each pair of eigenvalues. The spin is
// left out, because nothing stiff depends on it.
//
// The ball's accelerations are evaluated with the gimbal's unknown accelerations k, not with the
// servos' response to the state. For a stiff servo that response is a difference of large numbers.
// Its factor differs from node to node, so one Jacobian would fit no node well. With k, the stiff
// part is linear. For a nearly level plate the Jacobian is then nearly constant over the step, and
// three corrections are enough.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/error_estimate.hpp"
#include "solve/ensemble/newton.hpp"
#include "solve/ensemble/workspace.hpp"

namespace bbsim::solve::ensemble {

template <class Base>
struct LoopStep : Base {
  using Base::differentiate, Base::roll, Base::turn, Base::without_servos;
  using Base::lanes, Base::motions, Base::nq, Base::nv, Base::packs, Base::rows, Base::s;
  using Base::phi, Base::spin, Base::theta, Base::x;
  using typename Base::Jacobian, typename Base::Mask, typename Base::P, typename Base::Pack,
      typename Base::Scene, typename Base::Signals, typename Base::Workspace;

  // The change of the states in the last iteration.
  struct Change {
    P q[nq], v[nv];
  };

  // Integrates k to the states at the nodes.
  BBSIM_INLINE static void integrate(const Scene& scene, Pack& of, P h, Change& change) {
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      change.v[i] = P(0.0);
      if (i < nq) change.q[i] = P(0.0);
    }
    constexpr int together = 2;
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P q[together][nq], v[together][nv];
      Base::template integrate<together>(of, h, first, 0, q, v);
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
        P moved[nv];
        // Measure the change at every other node. That is enough for a polynomial over the step.
        const bool counts = j == together - 1;
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) {
          if (counts) moved[i] = v[j][i] - of.v_at[first + j][i];
          of.v_at[first + j][i] = v[j][i];
          if (i >= nq) continue;
          if (counts)
            change.q[i] = larger_of(change.q[i], size_of(q[j][i] - of.q_at[first + j][i]));
          of.q_at[first + j][i] = q[j][i];
        }
        if (!counts) continue;
        without_servos(scene, moved);
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) change.v[i] = larger_of(change.v[i], size_of(moved[i]));
      }
    }
  }

  BBSIM_INLINE static P weighted(const Pack& of, const Change& change) {
    P most(0.0);
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      most = larger_of(most, change.v[i] * of.v_weight[i]);
      if (i < nq) most = larger_of(most, change.q[i] * of.q_weight[i]);
    }
    return most;
  }

  // Sets the residuals f - k at the nodes, and k of the spin to its acceleration. Lanes that are
  // not active get zero residuals and keep their k.
  template <bool small>
  [[gnu::noinline, gnu::flatten]] static void take_residuals(const Workspace& w, int p, Mask active,
                                                             Pack& of) {
    const Scene scene = Base::scene(w, p);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      P turning[2], rolling[3];
      turn(scene, of.method.reference[j], of.q_at[j], of.v_at[j], turning);
      const P assumed[2] = {of.k[j][phi], of.k[j][theta]};
      roll(scene, Base::template direction<small>(of.q_at[j][phi]),
           Base::template direction<small>(of.q_at[j][theta]), of.q_at[j], of.v_at[j], assumed,
           rolling);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        of.method.residual[j][i] = choose(active, rolling[i] - of.k[j][i], P(0.0));
        of.method.residual[j][phi + i] = choose(active, turning[i] - assumed[i], P(0.0));
      }
      of.k[j][spin] = choose(active, rolling[2], of.k[j][spin]);
    }
  }

  // A step below this fraction of the last one starts from that one's polynomials.
  static constexpr double much_shorter = 0.75;

  // Sets k and the states at the nodes from the polynomials of the last step. For a step as long as
  // the last one they are useless. For a much shorter one, as on the way to infinity, they are
  // accurate to a thousandth and save three iterations.
  [[gnu::noinline, gnu::flatten]] static void extrapolate(const Scene& scene, P h, Pack& of) {
    P series[s][nv];
#pragma GCC unroll 1
    for (int m = 0; m < s; ++m) {
      P sum[nv];
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) sum[i] = P(0.0);
#pragma GCC unroll 1
      for (int j = 0; j < s; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) sum[i] += P(rows.legendre[j][m]) * of.k_before[j][i];
      }
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) series[m][i] = sum[i];
    }
    const P ratio = h / of.h_before;
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const P at = P(1.0) + P(2.0 * rows.c[j]) * ratio;
      P sum[nv];
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) sum[i] = series[0][i];
      Base::Courses::polynomials(
          at, [&](int m, P value) __attribute__((always_inline)) {
            if (m >= s) return;
#pragma GCC unroll 8
            for (int i = 0; i < nv; ++i) sum[i] += series[m][i] * value;
          });
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) of.k[j][i] = sum[i];
    }
    Change change;
    integrate(scene, of, h, change);
  }

  static constexpr int most_turns = 12;

  // Solves one pack. Returns which lanes converged. A lane that has converged, or will not, takes
  // no part in further iterations.
  [[gnu::flatten]] static Mask solve(Workspace& w, int p, int& turns) {
    Pack& of = w.of[p];
    const Scene scene = Base::scene(w, p);
    const P from = Base::from(w, p), h = Base::length(w, p);
    const bool moderate = scene.moderate_until(from + h);
    // First guess: constant accelerations, in lanes without extrapolation.
    const Mask known = (Mask)(h.v < (P(much_shorter) * of.h_before).v);
    if (simd::any_of<P>(known)) extrapolate(scene, h, of);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const P time = P(rows.c[j]) * h;
      const P at = from + time;
      of.method.reference[j] = moderate ? scene.template signals<true>(at) : scene.signals(at);
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        const P gain = time * of.k_end[i];
        of.k[j][i] = choose(known, of.k[j][i], of.k_end[i]);
        of.v_at[j][i] = choose(known, of.v_at[j][i], of.v[i] + gain);
        if (i >= nq) continue;
        of.q_at[j][i] = choose(known, of.q_at[j][i], of.q[i] + time * (of.v[i] + P(0.5) * gain));
      }
    }
    Change change;
    {
      constexpr int middle = s / 2;
      Jacobian at;
      const P turning[2] = {of.k[middle][phi], of.k[middle][theta]};
      differentiate(scene, of.method.reference[middle], of.q_at[middle], of.v_at[middle], turning,
                    at);
      Base::factor(at, h, of.method);
    }
    constexpr double slow = 0.7;
    const StopTest stop(1e-2, w.shared.rtol);
    P last(0.0);
    Mask resting{}, active = ~Mask{};
    for (turns = 1;; ++turns) {
      Base::are_small(of) ? take_residuals<true>(w, p, active, of)
                          : take_residuals<false>(w, p, active, of);
      Base::correct(of.method, of.method.residual, of.k);
      integrate(scene, of, h, change);
      if (turns == 1) Base::weigh(w, scene, of);
      const P now = weighted(of, change);
      // A lane that is not finite stops here; estimate() tests its states.
      const P contraction = turns > 1 ? P::of(now.v / last.v) : P(1.0);
      const Mask rests =
          (Mask)(now.v <= P(stop.enough).v) | stop.passes(now, contraction) | ~is_finite(now);
      resting |= active & rests;
      active &= ~rests;
      if (turns > 3) active &= ~(Mask)(now.v > (P(slow) * last).v);
      if (!simd::any_of<P>(active) || turns >= most_turns) return resting;
      last = now;
    }
  }

  // The fastest rate of each loop, 1/s, over all paths from an acceleration back to itself. The
  // rate of a path is the n-th root of the product of its couplings, where n is the number of
  // integrations on it. A coupling is the largest row sum of a block of the Jacobian, in SI units.
  [[gnu::flatten]] static void rates(const void* workspace, double* rates) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Pack& of = w.of[p];
      const Scene scene = Base::scene(w, p);
      const Signals reference = scene.signals(P(0.0));
      P turning[2];
      turn(scene, reference, of.q, of.v, turning);
      Jacobian at;
      differentiate(scene, reference, of.q, of.v, turning, at);
      const auto norm = [&](const auto& matrix, int row, int column)
          __attribute__((always_inline)) {
        P norm(0.0);
        for (int i = row; i < row + 2; ++i) {
          norm = larger_of(norm, size_of(matrix[i][column]) + size_of(matrix[i][column + 1]));
        }
        return norm;
      };
      const P by_velocity = norm(at.by_v, phi, x), by_place = norm(at.by_q, phi, x);
      const P ball_by_turning = norm(at.by_turning, x, 0), ball_by_rate = norm(at.by_v, x, phi);
      const P ball_by_angle = norm(at.by_q, x, phi);
      P fastest = larger_of(norm(at.by_v, x, x), norm(at.by_v, phi, phi));
      fastest = larger_of(fastest, ball_by_turning * by_velocity);
      for (const P& squared :
           {norm(at.by_q, x, x), norm(at.by_q, phi, phi), ball_by_turning * by_place,
            ball_by_rate * by_velocity, simd::root_of(ball_by_angle * by_place)}) {
        fastest = larger_of(fastest, simd::root_of(squared));
      }
      for (const P& cubed : {ball_by_rate * by_place, ball_by_angle * by_velocity}) {
        fastest = larger_of(fastest, cube_root_of(cubed));
      }
      for (int k = 0; k < scene.harmonic_count; ++k) {
        fastest += size_of(scene.harmonics[k].frequency);
      }
      fastest.store(rates + p * lanes);
    }
  }

  BBSIM_INLINE static P cube_root_of(P a) {
    for (int l = 0; l < lanes; ++l) a.v[l] = __builtin_cbrt(a.v[l]);
    return a;
  }
};

}  // namespace bbsim::solve::ensemble
