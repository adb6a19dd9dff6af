// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The memory of a group of cases from step to step, the states at a step's nodes, and dense output
// over the last step.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/dense_output.hpp"
#include "solve/ensemble/equations.hpp"

namespace bbsim::solve::ensemble {

// `Method`: Newton or Linear.
template <class Method>
struct Work : Method {
  using Method::lanes, Method::nq, Method::nv, Method::packs, Method::rows, Method::s;
  using Method::phi, Method::theta, Method::unknown, Method::with_position;
  using typename Method::P, typename Method::Mask, typename Method::Scene;
  static constexpr int unknowns = sizeof(unknown) / sizeof(unknown[0]);
  using Courses = DenseOutput<P, s, 2>;
  enum Half : int { places, angles };  // halves of the positions: x, y and phi, theta

  struct Pack {
    P q[nq], v[nv];  // the present state
    P k_end[nv];     // accelerations there
    // The last accepted step: its length (0 if it was not kept) and the accelerations at its nodes.
    P h_before, k_before[s][nv];
    P k[s][nv], q_at[s][nq], v_at[s][nv];  // at the nodes of the last attempt
    typename Method::Memory method;
    P q_weight[nq], v_weight[nv];  // inverse tolerances
    Courses courses[2];            // of the last attempt, by halves
    P series[s + 2][2];            // of places (dense_rows.hpp)
  };

  struct alignas(64) Workspace {
    Cases cases;
    int harmonic_count;  // the most of any case
    Shared shared;
    Spans spans;              // of the last attempt
    bool courses[2], series;  // whether they belong to the last attempt
    Pack of[packs];
  };

  BBSIM_INLINE static Scene scene(const Workspace& w, int p) {
    return Scene(w.cases, w.harmonic_count, p);
  }
  // The start and length of a pack's last attempt, s.
  BBSIM_INLINE static P from(const Workspace& w, int p) { return Method::lane(w.spans.from, p); }
  BBSIM_INLINE static P length(const Workspace& w, int p) {
    return Method::lane(w.spans.length, p);
  }
  BBSIM_INLINE static Mask mask(const Lanes& of, int p) {
    Mask mask;
    __builtin_memcpy(&mask, of.of + p * lanes, sizeof(mask));
    return mask;
  }

  // Integrates the unknown accelerations to the states at `count` nodes from `first` on. The sums
  // begin with node `oldest`.
  template <int count>
  BBSIM_INLINE static void integrate(const Pack& of, P h, int first, int oldest,
                                     P (&q)[count][with_position], P (&v)[count][unknowns]) {
    P once[count][unknowns], twice[count][with_position];
#pragma GCC unroll 2
    for (int n = 0; n < count; ++n) {
#pragma GCC unroll 8
      for (int i = 0; i < unknowns; ++i) {
        once[n][i] = P(0.0);
        if (i < with_position) twice[n][i] = P(0.0);
      }
    }
    const auto add = [&](int j) __attribute__((always_inline)) {
#pragma GCC unroll 2
      for (int n = 0; n < count; ++n) {
        const P a(rows.a[first + n][j]), b(rows.a_squared[first + n][j]);
#pragma GCC unroll 8
        for (int i = 0; i < unknowns; ++i) {
          once[n][i] += a * of.k[j][unknown[i]];
          if (i < with_position) twice[n][i] += b * of.k[j][unknown[i]];
        }
      }
    };
#pragma GCC unroll 2
    for (int j = oldest; j < s; ++j) add(j);
#pragma GCC unroll 2
    for (int j = 0; j < oldest; ++j) add(j);
#pragma GCC unroll 2
    for (int n = 0; n < count; ++n) {
      const P time = P(rows.c[first + n]) * h;
#pragma GCC unroll 8
      for (int i = 0; i < unknowns; ++i) {
        const int from = unknown[i];
        v[n][i] = of.v[from] + h * once[n][i];
        if (i < with_position) q[n][i] = of.q[from] + (time * of.v[from] + (h * h) * twice[n][i]);
      }
    }
  }

  // Sets the weights from the tolerances and the largest states over the step. The absolute
  // tolerance of a servo's rate is omega_n times that of an angle. Otherwise a servo's start would
  // take dozens of steps for motions that show neither in an angle nor in the ball's position.
  BBSIM_INLINE static void weigh(const Workspace& w, const Scene& scene, Pack& of) {
    const P rtol(w.shared.rtol), atol(w.shared.atol);
#pragma GCC unroll 8
    for (const int i : unknown) {
      P v = size_of(of.v[i]), q(0.0), least = atol;
      if (i < nq) q = size_of(of.q[i]);
#pragma GCC unroll 1
      for (int j = 0; j < s; ++j) {
        v = larger_of(v, size_of(of.v_at[j][i]));
        if (i < nq) q = larger_of(q, size_of(of.q_at[j][i]));
      }
      if (Method::actuation == Actuation::by_servo && (i == phi || i == theta)) {
        least = atol * larger_of(P(1.0), scene.servo.omega_n);
      }
      of.v_weight[i] = P(1.0) / (rtol * v + least);
      if (i < nq) of.q_weight[i] = P(1.0) / (rtol * q + atol);
    }
  }

  // Whether all angles stay within pi/4. The cheaper sines must be the same there bit for bit, or a
  // lane's result would depend on its companions.
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

  template <Half half>
  [[gnu::flatten]] static void make_courses(Workspace& w) {
    if (w.courses[half]) return;
    w.courses[half] = true;
    constexpr int first = 2 * half;
    for (int p = 0; p < packs; ++p) {
      Pack& of = w.of[p];
      const P h = length(w, p);
      of.courses[half].make(
          rows.legendre,
          h, [&](int j, int i) __attribute__((always_inline)) { return h * of.k[j][first + i]; },
          [&](int i) __attribute__((always_inline)) { return of.q[first + i]; },
          [&](int i) __attribute__((always_inline)) { return of.v[first + i]; });
    }
  }
};

}  // namespace bbsim::solve::ensemble
