// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a group of closed loops has in memory from step to step, and its motion between the nodes.
//
// Included only by the kernels; see simd/pack.hpp for why all is inlined or tagged.
#pragma once

#include "solve/collocation/dense_output.hpp"
#include "solve/loop/newton.hpp"

namespace bbsim::solve::loop {

template <class Isa, Drives drives, int nodes>
struct Work : Newton<Isa, drives, nodes> {
  using Base = Newton<Isa, drives, nodes>;
  using Base::nq, Base::nv, Base::packs, Base::rows;
  using typename Base::P, typename Base::Mask, typename Base::Matrices, typename Base::Reference;
  static constexpr int s = nodes;
  using Courses = DenseOutput<P, s, 2>;
  enum Half : int { places, angles };  // of the positions, and their velocities

  struct Pack {
    P q[nq], v[nv];  // the present state
    P k_end[nv];     // accelerations there
    // Of the last step that was accepted: its length, 0 if it was not kept, and accelerations at
    // its nodes.
    P h_before, k_before[s][nv];
    // At the nodes of the last attempt.
    P k[s][nv], q_at[s][nq], v_at[s][nv], residual[s][nq];
    Reference reference[s];
    Matrices newton;
    P q_weight[nq], v_weight[nv];  // one over the tolerances
    Courses courses[2];            // of the last attempt, by halves
    P series[s + 2][2];            // of places (rows_within.hpp)
  };

  struct alignas(64) Workspace {
    Loops loops;
    Spans spans;  // of the last attempt
    double rtol, atol;
    bool courses[2], series;  // whether they are those of it
    Pack of[packs];
  };

  // Of a pack's last attempt: where it began and how long it is, s.
  BBSIM_INLINE static P from(const Workspace& w, int p) {
    return Base::Loop::lane(w.spans.from, p);
  }
  BBSIM_INLINE static P length(const Workspace& w, int p) {
    return Base::Loop::lane(w.spans.length, p);
  }
  // Which of a pack's lanes take part.
  BBSIM_INLINE static Mask mask(const Lanes& lanes, int p) {
    Mask mask;
    __builtin_memcpy(&mask, lanes.of + p * Base::lanes, sizeof(mask));
    return mask;
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

}  // namespace bbsim::solve::loop
