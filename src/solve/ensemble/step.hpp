// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A step of a group of cases, for one actuation, one number of nodes and one instruction set.
//
// Radau IIA as in radau/step.hpp, with one case in each lane and a loop over the nodes. The
// iteration is in loop_step.hpp and given_step.hpp.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/error_estimate.hpp"
#include "solve/ensemble/dense_rows.hpp"
#include "solve/ensemble/maxima.hpp"

namespace bbsim::solve::ensemble {

// `Iteration`: LoopStep or GivenStep.
template <class Iteration>
struct Step : Iteration {
  using Base = Iteration;
  using Base::angles, Base::places;
  using Base::lanes, Base::motions, Base::nq, Base::nv, Base::packs, Base::rows, Base::s,
      Base::unknown;
  using typename Base::Mask, typename Base::P, typename Base::Pack, typename Base::Scene,
      typename Base::Vector, typename Base::Workspace;

  // The squares of the estimated errors: the first coefficient left out, integrated once for a
  // velocity and twice for a position.
  [[gnu::flatten]] static P estimate(const Workspace& w, int p) {
    const Pack& of = w.of[p];
    const Scene scene = Base::scene(w, p);
    const P once = Base::length(w, p) * P(1.0 / (2 * s + 1));
    const P twice = once * once;
    LastCoefficients<P, s, nv> series(rows.legendre, of.k);
    P error(0.0);
#pragma GCC unroll 8
    for (const int i : unknown) {
      if (i >= nq) continue;
      error = larger_of(error, series.left_out_squared(i, twice * of.q_weight[i]));
    }
#pragma GCC unroll 4
    for (auto& coefficients : series.of) Base::without_servos(scene, coefficients);
    Mask finite = ~Mask{};
#pragma GCC unroll 8
    for (const int i : unknown) {
      error = larger_of(error, series.left_out_squared(i, once * of.v_weight[i]));
      finite &= is_finite(of.v_at[s - 1][i]);
      if (i < nq) finite &= is_finite(of.q_at[s - 1][i]);
    }
    return P::of((Vector)((Mask)error.v | ~finite));  // all bits set: NaN
  }

  static void start(void* workspace, const Shared& shared) {
    __builtin_memset(workspace, 0, sizeof(Workspace));
    static_cast<Workspace*>(workspace)->shared = shared;
  }

  BBSIM_INLINE static int numbers_of(int harmonic_count) {
    return numbers - (most_harmonics - harmonic_count) * numbers_per_harmonic;
  }

  static void load(void* workspace, int lane, const Progress& from) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    if (from.of.harmonic_count > w.harmonic_count) w.harmonic_count = from.of.harmonic_count;
    const auto* const row = reinterpret_cast<const double*>(&from.of);
    auto* const rows = reinterpret_cast<double*>(&w.cases);
    for (int i = 0; i < numbers_of(w.harmonic_count); ++i) rows[i * group + lane] = row[i];
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

  static void store(const void* workspace, int lane, Progress& into) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    into.of.harmonic_count = w.harmonic_count;
    auto* const row = reinterpret_cast<double*>(&into.of);
    const auto* const rows = reinterpret_cast<const double*>(&w.cases);
    for (int i = 0; i < numbers_of(w.harmonic_count); ++i) row[i] = rows[i * group + lane];
    const Pack& from = w.of[lane / lanes];
    const int l = lane % lanes;
    for (int i = 0; i < nv; ++i) {
      into.state[motions.of[i].velocity] = from.v[i].v[l];
      into.acceleration[i] = from.k_end[i].v[l];
      if (i < nq) into.state[motions.of[i].position] = from.q[i].v[l];
    }
    into.last_step = from.h_before.v[l];
    if (into.last_step == 0) return;
    for (int j = 0; j < s; ++j) {
      for (int i = 0; i < nv; ++i) into.last_accelerations[j][i] = from.k_before[j][i].v[l];
    }
  }

  static void attempt(void* workspace, const Spans& spans, Attempt& result) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.spans = spans;
    w.courses[places] = w.courses[angles] = w.series = false;
    result.turns = 0;
    for (int p = 0; p < packs; ++p) {
      int turns = 0;
      const Mask resting = Base::solve(w, p, turns);
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

  static constexpr Kernel kernel{Base::actuation,
                                 s,
                                 sizeof(Workspace),
                                 start,
                                 Base::rates,
                                 load,
                                 store,
                                 attempt,
                                 DenseRows<Base>::evaluate,
                                 DenseRows<Base>::squared_errors,
                                 Maxima<Base>::raise_maxima,
                                 accept};
};

}  // namespace bbsim::solve::ensemble
