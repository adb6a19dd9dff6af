// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A step of a group of closed loops, for one way to drive the gimbal, one number of nodes and one
// instruction set.
//
// Radau IIA as in radau/step.hpp, with another loop in each lane and the nodes in a loop: the
// unknowns are the accelerations k at the nodes,
//     v = v(0) + h A k,    q = q(0) + c h v(0) + h^2 A A k,    k = f(t, q, v, k),
// and Newton's iteration corrects them,
//     (I - Jk - h A (x) Jv - h^2 A A (x) Jq) dk = f - k,
// which the eigenvectors of A part into a complex system for each pair of eigenvalues. The spin is
// no part of it: nothing that is stiff comes by way of it.
//
// The ball's accelerations are taken where the gimbal's are k, not what the servos would do at the
// state: of a stiff servo that is a difference of large numbers, and as it stands before another
// factor at each node, one Jacobian for all of them would be far from each. As it is, what is stiff
// is linear, and loops about a plane that is nearly level have nearly the same Jacobian throughout
// a step: three corrections do.
#pragma once

#include "solve/collocation/convergence.hpp"
#include "solve/collocation/error_estimate.hpp"
#include "solve/loop/looking.hpp"
#include "solve/loop/rows_within.hpp"

namespace bbsim::solve::loop {

template <class Isa, Drives drives, int s>
struct Step : Work<Isa, drives, s> {
  using Base = Work<Isa, drives, s>;
  using Base::angles, Base::phi, Base::places, Base::spin, Base::theta, Base::x;
  using Base::differentiate, Base::roll, Base::turn, Base::without_servos;
  using Base::lanes, Base::motions, Base::n, Base::nq, Base::nv, Base::packs, Base::rows;
  using typename Base::Jacobian, typename Base::Loop, typename Base::Mask, typename Base::P,
      typename Base::Pack, typename Base::Reference, typename Base::Vector,
      typename Base::Workspace;

  // How far the last turn moved the states.
  struct Change {
    P q[nq], v[nv];
  };

  // The states at the nodes.
  BBSIM_INLINE static void integrate(const Loop& loop, Pack& of, P h, Change& change) {
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      change.v[i] = P(0.0);
      if (i < nq) change.q[i] = P(0.0);
    }
    constexpr int together = 2;
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P once[together][nv], twice[together][nq];
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) {
          once[j][i] = P(0.0);
          if (i < nq) twice[j][i] = P(0.0);
        }
      }
#pragma GCC unroll 2
      for (int m = 0; m < s; ++m) {
#pragma GCC unroll 2
        for (int j = 0; j < together; ++j) {
          const P a(rows.a[first + j][m]), b(rows.a_squared[first + j][m]);
#pragma GCC unroll 8
          for (int i = 0; i < nv; ++i) {
            once[j][i] += a * of.k[m][i];
            if (i < nq) twice[j][i] += b * of.k[m][i];
          }
        }
      }
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
        const P time = P(rows.c[first + j]) * h;
        P moved[nv];
        // Every other node tells enough: what is left is a polynomial over the step.
        const bool counts = j == together - 1;
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) {
          const P v = of.v[i] + h * once[j][i];
          if (counts) moved[i] = v - of.v_at[first + j][i];
          of.v_at[first + j][i] = v;
          if (i >= nq) continue;
          const P q = of.q[i] + (time * of.v[i] + (h * h) * twice[j][i]);
          if (counts) change.q[i] = larger_of(change.q[i], size_of(q - of.q_at[first + j][i]));
          of.q_at[first + j][i] = q;
        }
        if (!counts) continue;
        without_servos(loop, moved);
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) change.v[i] = larger_of(change.v[i], size_of(moved[i]));
      }
    }
  }

  // The tolerances over the step, by how far the states get in it. A servo's start would take
  // dozens of steps for motions that no angle shows and no row of the ball's place: its rate counts
  // as omega_n times an angle.
  BBSIM_INLINE static void weigh(const Workspace& w, const Loop& loop, Pack& of) {
    const P rtol(w.rtol), atol(w.atol);
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      P v = size_of(of.v[i]), q(0.0), least = atol;
      if (i < nq) q = size_of(of.q[i]);
#pragma GCC unroll 1
      for (int j = 0; j < s; ++j) {
        v = larger_of(v, size_of(of.v_at[j][i]));
        if (i < nq) q = larger_of(q, size_of(of.q_at[j][i]));
      }
      if (drives == Drives::angle && (i == phi || i == theta)) {
        least = atol * larger_of(P(1.0), loop.servo.omega_n);
      }
      of.v_weight[i] = P(1.0) / (rtol * v + least);
      if (i < nq) of.q_weight[i] = P(1.0) / (rtol * q + atol);
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

  // Whether no angle gets beyond a quarter of pi: sines are the same to the bit then, or a lane's
  // would depend on another's, and cost less.
  BBSIM_INLINE static bool are_small(const Pack& of) {
    P most(0.0);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      most = larger_of(most, larger_of(size_of(of.q_at[j][phi]), size_of(of.q_at[j][theta])));
    }
    return !simd::any_of<P>((Mask)(most.v > 0.785));
  }

  template <bool small>
  BBSIM_INLINE static SinCos<P> direction(P angle) {
    if constexpr (small) return simd::sin_cos_of_small(angle);
    return sin_cos(angle);
  }

  // The accelerations at the nodes, and how far k is from them; of the spin k is them. Nothing of
  // either where a lane does not take part: its k stays as it is.
  template <bool small>
  [[gnu::noinline, gnu::flatten]] static void take_residuals(const Workspace& w, int p, Mask active,
                                                             Pack& of) {
    const Loop loop(w.loops, p);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      P turning[2], rolling[3];
      turn(loop, of.reference[j], of.q_at[j], of.v_at[j], turning);
      const P assumed[2] = {of.k[j][phi], of.k[j][theta]};
      roll(loop, direction<small>(of.q_at[j][phi]), direction<small>(of.q_at[j][theta]), of.q_at[j],
           of.v_at[j], assumed, rolling);
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        of.residual[j][i] = choose(active, rolling[i] - of.k[j][i], P(0.0));
        of.residual[j][phi + i] = choose(active, turning[i] - assumed[i], P(0.0));
      }
      of.k[j][spin] = choose(active, rolling[2], of.k[j][spin]);
    }
  }

  // How much shorter than the last step one is that begins with that one's polynomials.
  static constexpr double much_shorter = 0.75;

  // The accelerations of the last step's polynomials, and what comes of them, at the nodes. Of a
  // step as long as the last one they are of no use; of one that is much shorter, as on the way to
  // infinity, they are right to a thousandth, where others spare three turns less.
  [[gnu::noinline, gnu::flatten]] static void extrapolate(const Loop& loop, P h, Pack& of) {
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
    integrate(loop, of, h, change);
  }

  static constexpr int most_turns = 12;

  // One pack; returns which lanes came to rest. One that has, or that will not, takes no further
  // part: others may need more turns.
  [[gnu::flatten]] static Mask solve(Workspace& w, int p, int& turns) {
    Pack& of = w.of[p];
    const Loop loop(w.loops, p);
    const P from = Base::from(w, p), h = Base::length(w, p);
    const bool moderate = loop.moderate_until(from + h);
    // At first accelerations that go on as they were, in lanes that have nothing better.
    const Mask known = (Mask)(h.v < (P(much_shorter) * of.h_before).v);
    if (simd::any_of<P>(known)) extrapolate(loop, h, of);
#pragma GCC unroll 1
    for (int j = 0; j < s; ++j) {
      const P time = P(rows.c[j]) * h;
      const P at = from + time;
      of.reference[j] = moderate ? loop.template reference<true>(at) : loop.reference(at);
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
      differentiate(loop, of.reference[middle], of.q_at[middle], of.v_at[middle], turning, at);
      Base::factor(at, h, of.newton);
    }
    constexpr double slow = 0.7;
    const StopTest stop(1e-2, w.rtol);
    P last(0.0);
    Mask resting{}, active = ~Mask{};
    for (turns = 1;; ++turns) {
      are_small(of) ? take_residuals<true>(w, p, active, of)
                    : take_residuals<false>(w, p, active, of);
      Base::correct(of.newton, of.residual, of.k);
      integrate(loop, of, h, change);
      if (turns == 1) weigh(w, loop, of);
      const P now = weighted(of, change);
      // What is not finite is at rest: the states tell.
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

  // The first coefficient left out, integrated once for a velocity, twice for a position.
  [[gnu::flatten]] static P estimate(const Workspace& w, int p) {
    const Pack& of = w.of[p];
    const Loop loop(w.loops, p);
    const P once = Base::length(w, p) * P(1.0 / (2 * s + 1));
    const P twice = once * once;
    LastCoefficients<P, s, nv> series(rows.legendre, of.k);
    P error(0.0);
#pragma GCC unroll 8
    for (int i = 0; i < nq; ++i) {
      error = larger_of(error, series.left_out_squared(i, twice * of.q_weight[i]));
    }
#pragma GCC unroll 4
    for (auto& coefficients : series.of) without_servos(loop, coefficients);
    Mask finite = ~Mask{};
#pragma GCC unroll 8
    for (int i = 0; i < nv; ++i) {
      error = larger_of(error, series.left_out_squared(i, once * of.v_weight[i]));
      finite &= is_finite(of.v_at[s - 1][i]);
      if (i < nq) finite &= is_finite(of.q_at[s - 1][i]);
    }
    return P::of((Vector)((Mask)error.v | ~finite));  // all bits: no number
  }

  static void start(void* workspace, double rtol, double atol) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.rtol = rtol;
    w.atol = atol;
  }

  static constexpr int numbers = sizeof(LoopCase) / sizeof(double);

  static void load(void* workspace, int lane, const LoopState& from) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    double loop[numbers];
    __builtin_memcpy(loop, &from.loop, sizeof(loop));
    auto* const rows = reinterpret_cast<double*>(&w.loops);
    for (int i = 0; i < numbers; ++i) rows[i * group + lane] = loop[i];
    Pack& into = w.of[lane / lanes];
    const int l = lane % lanes;
    for (int i = 0; i < nv; ++i) {
      into.v[i].v[l] = from.state[motions.of[i].velocity];
      into.k_end[i].v[l] = from.acceleration[i];
      if (i < nq) into.q[i].v[l] = from.state[motions.of[i].position];
    }
    into.h_before.v[l] = from.last_step;
    if (from.last_step == 0) return;
    for (int j = 0; j < s; ++j) {
      for (int i = 0; i < nv; ++i) into.k_before[j][i].v[l] = from.last_accelerations[j][i];
    }
  }

  static void store(const void* workspace, int lane, LoopState& into) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    double loop[numbers];
    const auto* const rows = reinterpret_cast<const double*>(&w.loops);
    for (int i = 0; i < numbers; ++i) loop[i] = rows[i * group + lane];
    __builtin_memcpy(&into.loop, loop, sizeof(loop));
    const Pack& from = w.of[lane / lanes];
    const int l = lane % lanes;
    for (int i = 0; i < nv; ++i) {
      into.state[motions.of[i].velocity] = from.v[i].v[l];
      into.acceleration[i] = from.k_end[i].v[l];
      if (i < nq) into.state[motions.of[i].position] = from.q[i].v[l];
    }
    into.last_step = from.h_before.v[l];
    for (int j = 0; j < s; ++j) {
      for (int i = 0; i < nv; ++i) into.last_accelerations[j][i] = from.k_before[j][i].v[l];
    }
  }

  [[gnu::flatten]] static void couplings(const Loops& loops, Couplings& result) {
    for (int p = 0; p < packs; ++p) {
      const Loop loop(loops, p);
      P q[nq], v[nv];
      for (int i = 0; i < nv; ++i) {
        v[i] = Loop::lane(loops.initial[motions.of[i].velocity], p);
        if (i < nq) q[i] = Loop::lane(loops.initial[motions.of[i].position], p);
      }
      const Reference reference = loop.reference(P(0.0));
      P turning[2];
      turn(loop, reference, q, v, turning);
      Jacobian at;
      differentiate(loop, reference, q, v, turning, at);
      const auto put = [&](const auto& matrix, int row, int column, double(&to)[group])
          __attribute__((always_inline)) {
        P norm(0.0);
        for (int i = row; i < row + 2; ++i) {
          norm = larger_of(norm, size_of(matrix[i][column]) + size_of(matrix[i][column + 1]));
        }
        norm.store(to + p * lanes);
      };
      put(at.by_turning, x, 0, result.ball_by_turning);
      put(at.by_v, x, x, result.ball_by_velocity);
      put(at.by_q, x, x, result.ball_by_place);
      put(at.by_v, x, phi, result.ball_by_rate);
      put(at.by_q, x, phi, result.ball_by_angle);
      put(at.by_v, phi, x, result.servo_by_velocity);
      put(at.by_q, phi, x, result.servo_by_place);
      put(at.by_v, phi, phi, result.servo_by_rate);
      put(at.by_q, phi, phi, result.servo_by_angle);
    }
  }

  static void attempt(void* workspace, const Spans& spans, Attempt& result) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.spans = spans;
    w.courses[places] = w.courses[angles] = w.series = false;
    result.turns = 0;
    for (int p = 0; p < packs; ++p) {
      int turns = 0;
      const Mask resting = solve(w, p, turns);
      if (turns > result.turns) result.turns = turns;
      estimate(w, p).store(result.error_squared + p * lanes);
      for (int l = 0; l < lanes; ++l) result.converged[p * lanes + l] = resting[l] != 0;
    }
  }

  static void accept(void* workspace, const Lanes& taken, const Lanes& kept) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int p = 0; p < packs; ++p) {
      const Mask mask = Base::mask(taken, p);
      Pack& of = w.of[p];
      const Mask keep = Base::mask(kept, p);
      of.h_before = choose(keep, Base::length(w, p), choose(mask, P(0.0), of.h_before));
      if (simd::any_of<P>(keep)) {
        for (int j = 0; j < s; ++j) {
          for (int i = 0; i < nv; ++i) {
            of.k_before[j][i] = choose(keep, of.k[j][i], of.k_before[j][i]);
          }
        }
      }
      for (int i = 0; i < nv; ++i) {
        of.v[i] = choose(mask, of.v_at[s - 1][i], of.v[i]);
        of.k_end[i] = choose(mask, of.k[s - 1][i], of.k_end[i]);
        if (i < nq) of.q[i] = choose(mask, of.q_at[s - 1][i], of.q[i]);
      }
    }
  }

  static constexpr Kernel kernel{s,
                                 sizeof(Workspace),
                                 start,
                                 couplings,
                                 load,
                                 store,
                                 attempt,
                                 RowsWithin<Base>::evaluate,
                                 Looking<Base>::look,
                                 accept};
};

template <class Isa>
inline constexpr Kernels kernels_of{
    Isa::lanes,
    {Step<Isa, Drives::acceleration, 8>::kernel, Step<Isa, Drives::acceleration, 12>::kernel},
    {Step<Isa, Drives::angle, 8>::kernel, Step<Isa, Drives::angle, 12>::kernel}};

}  // namespace bbsim::solve::loop