// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The collocation step, for one system, number of stages and instruction set.
//
// Radau IIA with s stages (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5 and
// IV.8), written for second-order systems q'' = a(t, q, q'). The only unknowns are the
// accelerations k_i at the s nodes:
//
//     v_i = v + h sum_j A_ij k_j,     q_i = q + h c_i v + h^2 sum_j (A A)_ij k_j.
//
// This halves the linear systems. A velocity without a position (the spin) has no q.
//
// In a loop with servos, a is a(t, q, q', k): the ball's accelerations are evaluated with the
// gimbal's accelerations among the unknowns. The only stiff part left is then linear.
//
// The stages lie in SIMD lanes: one evaluation of the right-hand side serves several stages. The
// eigenvectors of A make the Newton system block diagonal. Its blocks also lie in lanes:
//
//     (I - Jk - h l_k Jv - h^2 l_k^2 Jq) y_k = (T^-1 residual)_k,   k = 1 ... s/2, complex.
#pragma once

#include "solve/collocation/error_estimate.hpp"
#include "solve/radau/dense_rows.hpp"
#include "solve/radau/system_rates.hpp"

namespace bbsim::solve::radau {

template <class Isa, class System, int s>
struct Step
    : DenseRows<
          Collocation<Isa, System::motions, System::size, SystemRates<Isa, System>::first_turning,
                      SystemRates<Isa, System>::turning, s>> {
  using Rates = SystemRates<Isa, System>;
  static constexpr int turning = Rates::turning, first_turning = Rates::first_turning;
  using Base =
      DenseRows<Collocation<Isa, System::motions, System::size, first_turning, turning, s>>;
  using Base::table, Base::motions, Base::nv, Base::nq, Base::lanes, Base::packs;
  using typename Base::P, typename Base::Table;
  static constexpr int n = System::size;
  static constexpr bool steep = Rates::steep;

  struct alignas(64) Workspace : Base::Workspace {
    typename Rates::Inputs inputs[packs];
  };

  BBSIM_INLINE static const System& system_of(const Workspace& w) {
    return *static_cast<const System*>(w.system);
  }

  BBSIM_INLINE static void evaluate_rates(Workspace& w) {
#pragma GCC unroll 1
    for (int p = 0; p < packs; ++p) {
      P z[n], dz[n], given[turning + 1];
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        z[motions.of[i].velocity] = P::load(&w.v_stage.of[i][p * lanes]);
        if (i < nq) z[motions.of[i].position] = P::load(&w.q_stage.of[i][p * lanes]);
        if (i < turning) given[i] = P::load(&w.k.of[first_turning + i][p * lanes]);
      }
      Rates::rates(system_of(w), w.inputs[p], z, given, dz);
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) dz[motions.of[i].velocity].store(&w.f.of[i][p * lanes]);
    }
  }

  // The accelerations at the start of a step.
  static void accelerations(Workspace& w, double (&k)[nv]) {
    static_assert(turning == 0);
    P z[n], dz[n], given[1];
    for (int i = 0; i < nv; ++i) {
      z[motions.of[i].velocity] = P(w.v[i]);
      if (i < nq) z[motions.of[i].position] = P(w.q[i]);
    }
    Rates::rates(system_of(w), system_of(w).inputs(P(w.t)), z, given, dz);
    for (int i = 0; i < nv; ++i) k[i] = dz[motions.of[i].velocity].v[0];
  }

  // Sets the first guess of k, and v and q at the stages.
  BBSIM_INLINE static void guess(Workspace& w, double t, double h) {
    const double last_t = w.t, last_h = w.h;
    w.t = t;
    w.h = h;
    if (w.has_guess && !w.accepted) {
      Base::extrapolate(w, last_t, last_h);
      return;
    }
    double k[nv];
    for (int i = 0; i < nv; ++i) k[i] = w.has_guess ? w.k.of[i][s - 1] : 0;
    if constexpr (steep) {
      if (!w.has_guess) accelerations(w, k);
    }
    Base::hold(w, k);
  }

  // The stages' residual, as a velocity relative to the tolerance.
  static double residual(Workspace& w) {
    evaluate_rates(w);
    double square = 0;
    for (int i = 0; i < nv; ++i) {
      for (int j = 0; j < s; ++j) {
        const double part = w.h * (w.f.of[i][j] - w.k.of[i][j]) * w.v_weight[i];
        square += part * part;
      }
    }
    return __builtin_sqrt(square / s);
  }

  static void start(void* workspace, const Start& from) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    w.system = from.system;
    w.newton = !System::open_loop;
    Base::prepare(w, from);
  }

  static double rate(void* workspace, double t) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    constexpr double still[nv] = {};
    Rates::differentiate(system_of(w), t, w.q, w.v, still, w.jv, w.jq, w.jk);
    double jv = 0, jq = 0;
    for (int i = 0; i < nv; ++i) {
      // Includes the path through the gimbal's accelerations.
      double row_v = 0, row_q = 0;
      for (int j = 0; j < nv; ++j) {
        double by_v = w.jv[i][j], by_q = j < nq ? w.jq[i][j] : 0;
        for (int m = 0; m < turning; ++m) {
          by_v += w.jk[i][m] * w.jv[first_turning + m][j];
          if (j < nq) by_q += w.jk[i][m] * w.jq[first_turning + m][j];
        }
        row_v += size_of(by_v);
        row_q += size_of(by_q);
      }
      jv = larger_of(row_v, jv);
      jq = larger_of(row_q, jq);
    }
    return larger_of(__builtin_sqrt(jq), jv);
  }

  static constexpr int most_iterations = 25;

  static void attempt(void* workspace, double t, double h, Attempt* result) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    guess(w, t, h);
    w.has_guess = false;
    Attempt& a = *result;
    a = {Verdict::diverged, 0, 0, 0, 0, 0};
    for (int p = 0; p < packs; ++p) {
      w.inputs[p] = system_of(w).inputs(P(t) + P(h) * P::load(&table.c[p * lanes]));
    }
    bool factored = false;
    double last = 0, contraction = w.contraction;
    const StopTest stop(0.02, w.rtol);
    for (;;) {
      evaluate_rates(w);
      if (w.newton) {
        if (!factored) {
          // The Jacobian at mid-step.
          double q[nv], v[nv], k[nv];
          for (int i = 0; i < nv; ++i) {
            v[i] = w.v_stage.of[i][s / 2];
            k[i] = w.k.of[i][s / 2];
            if (i < nq) q[i] = w.q_stage.of[i][s / 2];
          }
          Rates::differentiate(system_of(w), t + table.c[s / 2] * h, q, v, k, w.jv, w.jq, w.jk);
          Base::factor(w);
          factored = true;
          ++a.jacobians;
        }
        Base::correct(w);
      } else {
        for (int i = 0; i < nv; ++i) {
          for (int p = 0; p < packs; ++p) {
            P::load(&w.f.of[i][p * lanes]).store(&w.k.of[i][p * lanes]);
          }
        }
      }
      const double change = __builtin_sqrt(Base::template integrate_stages<true>(w));
      ++a.iterations;
      a.right_hand_sides += s;
      if (!(change < 1e300)) {
        a.verdict = Verdict::not_finite;
        w.contraction = 1;
        return;
      }
      if (change == 0) {
        contraction = 0;
        break;
      }
      if (a.iterations > 1) {
        contraction = change / last;
        if (change > stop.floor && contraction > (w.newton ? 0.9 : 0.3)) {
          if (!w.newton) {
            w.newton = true;
            last = change;
            continue;
          }
          if (a.iterations > 2) {
            w.contraction = 1;
            return;
          }
        }
      }
      last = change;
      // The contraction is not known after the first iteration.
      if (change <= stop.enough || stop.passes(change, a.iterations > 1 ? contraction : 1)) break;
      if (a.iterations >= most_iterations) {
        w.contraction = 1;
        return;
      }
    }
    if constexpr (steep) {
      // Stiff motors magnify the residual of Newton's iteration, so test it, too.
      constexpr double hardly_solved = 30;
      a.right_hand_sides += s;
      if (!(residual(w) <= hardly_solved)) {
        w.contraction = 1;
        return;
      }
    }
    a.verdict = Verdict::converged;
    w.contraction = larger_of(contraction, 0.3 * w.contraction);
    w.has_guess = true;
    w.accepted = false;
    Base::estimate(w, a);
  }

  static constexpr Kernel kernel{s,           n,        sizeof(Workspace), &start,
                                 &rate,       &attempt, &Base::accept,     &Base::evaluate,
                                 &Base::state};
};

}  // namespace bbsim::solve::radau
