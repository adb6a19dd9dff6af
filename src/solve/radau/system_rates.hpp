// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The right-hand side of a system in the lanes of a step, and its Jacobian.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/compare.hpp"
#include "simd/dual.hpp"
#include "solve/radau/packed_table.hpp"

namespace bbsim::solve::radau {

template <class T>
const T& instance();  // for its type only

// The right-hand side and Jacobian of a system, for any number of stages.
template <class Isa, class System>
struct SystemRates {
  static constexpr int n = System::size;
  static constexpr auto motions = System::motions;
  static constexpr int nv = motions.count;
  static constexpr int nq = n - nv;
  static constexpr int lanes = Isa::lanes;
  using P = simd::Pack<Isa, lanes>;
  using Inputs = decltype(instance<System>().inputs(P()));

  // The number of accelerations that are arguments of the system's right-hand side, and the index
  // of the first.
  static constexpr int turning = [] {
    if constexpr (requires { System::first_axis; }) return System::axes;
    return 0;
  }();
  static constexpr int first_turning = [] {
    if constexpr (requires { System::first_axis; }) return System::first_axis;
    return 0;
  }();
  template <class Real>
  using Given = Real[turning + 1];

  // Whether the Jacobian may change by orders of magnitude close to a state, as the direction of
  // friction does near zero velocity. Newton's corrections can then be small although the error is
  // not.
  static constexpr bool steep = requires { System::steep; };

  template <class Real>
  BBSIM_INLINE static void rates(const System& system, const Inputs& in, const Real* z,
                                 const Given<Real>& given, Real* dz) {
    if constexpr (turning > 0) {
      system.derivative_of(in, z, given, dz);
    } else if constexpr (steep) {
      call_rates(system, in, z, dz);
    } else {
      system.derivative_of(in, z, dz);
    }
  }

  // The exact derivatives d k_i / d v_j, d k_i / d q_j and, for accelerations that are arguments, d
  // k_i / d k_j at (t, q, v, k).
  BBSIM_INLINE static void differentiate(const System& system, double t, const double* q,
                                         const double* v, const double* k, double (&jv)[nv][nv],
                                         double (&jq)[nv][nv], double (&jk)[nv][turning + 1]) {
    if constexpr (steep) {
      call_slopes(system, t, q, v, k, jv, jq, jk);
    } else {
      slopes(system, t, q, v, k, jv, jq, jk);
    }
  }

 private:
  // A long right-hand side is compiled once.
  [[gnu::noinline]] static void call_rates(const System& system, const Inputs& in, const P* z,
                                           P* dz) {
    system.derivative_of(in, z, dz);
  }
  [[gnu::noinline]] static void call_slopes(const System& system, double t, const double* q,
                                            const double* v, const double* k, double (&jv)[nv][nv],
                                            double (&jq)[nv][nv], double (&jk)[nv][turning + 1]) {
    slopes(system, t, q, v, k, jv, jq, jk);
  }

  BBSIM_INLINE static void slopes(const System& system, double t, const double* q, const double* v,
                                  const double* k, double (&jv)[nv][nv], double (&jq)[nv][nv],
                                  double (&jk)[nv][turning + 1]) {
    using D = simd::Dual<P>;
    const auto in = system.inputs(P(t));
    constexpr int directions = padded<n + turning, lanes>;
    alignas(64) double slope[nv][directions];
    for (int first = 0; first < directions; first += lanes) {
      D z[n], dz[n], given[turning + 1];
      alignas(64) double seed[directions][lanes] = {};
      for (int l = 0; l < lanes; ++l) seed[first + l][l] = 1;
      for (int i = 0; i < nv; ++i) {
        z[motions.of[i].velocity] = D(P(v[i]), P::load(seed[i]));
        if (i < nq) z[motions.of[i].position] = D(P(q[i]), P::load(seed[nv + i]));
        if (i < turning) given[i] = D(P(k[first_turning + i]), P::load(seed[n + i]));
      }
      if constexpr (turning > 0) {
        system.derivative_of(in, z, given, dz);
      } else {
        system.derivative_of(in, z, dz);
      }
      for (int i = 0; i < nv; ++i) dz[motions.of[i].velocity].slope.store(&slope[i][first]);
    }
    for (int i = 0; i < nv; ++i) {
      for (int j = 0; j < nv; ++j) jv[i][j] = slope[i][j];
      for (int j = 0; j < nq; ++j) jq[i][j] = slope[i][nv + j];
      for (int j = 0; j < turning; ++j) jk[i][j] = slope[i][n + j];
    }
  }
};

}  // namespace bbsim::solve::radau
