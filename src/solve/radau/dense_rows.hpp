// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows within the last step, from its polynomials.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/radau/collocation.hpp"

namespace bbsim::solve::radau {

// `Base`: Collocation.
template <class Base>
struct DenseRows : Base {
  using Base::lanes, Base::motions, Base::nq, Base::nv, Base::turns;
  using typename Base::P, typename Base::Workspace;
  static constexpr int n = Base::states, s = Base::nodes;

  // Rows are sums of p_m = P_m / scale[m]. With this scale the recurrence is p_(m+1) = rise[m] x
  // p_m - p_(m-1). It is the shortest one, and it has no sum of two products, which compilers could
  // fuse either way.
  struct ScaledLegendre {
    double scale[s + 3]{}, rise[s + 2]{};
    consteval ScaledLegendre() {
      scale[0] = scale[1] = 1;
      for (int m = 1; m < s + 2; ++m) {
        scale[m + 1] = scale[m - 1] * m / (m + 1);
        rise[m] = (2.0 * m + 1) / (m + 1) * scale[m] / scale[m + 1];
      }
    }
  };
  static constexpr ScaledLegendre polynomials{};

  // The integral of a series from -1 has the terms out_m = before[m] in_(m-1) - after[m] in_(m+1),
  // m > 0. Products with these tables are cheaper than quotients.
  template <bool of_scaled>
  struct Integration {
    double before[s + 2]{}, after[s + 2]{};
    consteval Integration() {
      const auto scale = [](int m) { return of_scaled ? polynomials.scale[m] : 1; };
      for (int m = 1; m < s + 2; ++m) {
        before[m] = polynomials.scale[m] / (scale(m - 1) * (2 * m - 1));
        after[m] = polynomials.scale[m] / (scale(m + 1) * (2 * m + 3));
      }
    }
  };
  template <bool of_scaled>
  static constexpr Integration<of_scaled> integration{};

  // `half` times the integral of a series from -1, plus `from`.
  template <int length, bool of_scaled>
  BBSIM_INLINE static void integrate_series(const double* k, double half, double from,
                                            double* out) {
    const auto at = [&](int m) { return m < length ? k[m] : 0.0; };
    constexpr const auto& by = integration<of_scaled>;
    out[0] = from + half * (at(0) - at(1) / 3);
#pragma GCC unroll 2
    for (int m = 1; m <= length; ++m) {
      out[m] = half * (k[m - 1] * by.before[m] - at(m + 1) * by.after[m]);
    }
  }

  static void evaluate(void* workspace, const double* times, std::size_t count, double* rows) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    if (!w.expanded) expand(w);
    if (w.gamma) {
      evaluate_rows<true>(w, times, count, rows);
    } else {
      evaluate_rows<false>(w, times, count, rows);
    }
  }

  // Expands velocities and positions into series. All callers share this function, so that all get
  // the same fused products.
  [[gnu::noinline]] static void expand(Workspace& w) {
    w.expanded = true;
    const double half = w.h / 2;
    for (int i = 0; i < nv; ++i) {
      integrate_series<s, false>(w.series.of[i], half, w.v[i], w.v_series[i]);
      if (i < nq || turns(w, i)) {
        integrate_series<s + 1, true>(w.v_series[i], half, w.q[i], w.q_series[i]);
      }
    }
  }

  // Rows are the same bit for bit, with or without the integral of u, and for any number of times.
  template <bool turned>
  BBSIM_INLINE static void evaluate_rows(Workspace& w, const double* times, std::size_t count,
                                         double* rows) {
    constexpr int row = n + (turned ? 1 : 0);
    // Evaluates two packs of times at once to hide the latency of the recurrence.
    while (count > lanes) {
      const std::size_t some = count < 2 * lanes ? count : 2 * lanes;
      evaluate_some<turned, 2>(w, times, static_cast<int>(some), rows);
      times += some;
      rows += some * row;
      count -= some;
    }
    if (count > 0) {
      evaluate_some<turned, 1>(w, times, static_cast<int>(count), rows);
    }
  }

  template <bool turned, int together>
  BBSIM_INLINE static void evaluate_some(Workspace& w, const double* times, int count,
                                         double* rows) {
    constexpr int row = n + (turned ? 1 : 0);
    const double half = w.h / 2;
    alignas(64) double at[together * lanes];
    for (int l = 0; l < together * lanes; ++l) at[l] = times[l < count ? l : 0];
    P x[together], before[together], now[together], q[nv][together], v[nv][together];
#pragma GCC unroll 2
    for (int p = 0; p < together; ++p) {
      x[p] = (P::load(at + p * lanes) - P(w.t + half)) * P(1 / half);
      before[p] = P(1.0);
      now[p] = x[p];
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        v[i][p] = w.v_series[i][0] + w.v_series[i][1] * x[p];
        if (turned || i < nq) q[i][p] = w.q_series[i][0] + w.q_series[i][1] * x[p];
      }
    }
    for (int m = 1; m <= s; ++m) {
#pragma GCC unroll 2
      for (int p = 0; p < together; ++p) {
        const P next = (polynomials.rise[m] * x[p]) * now[p] - before[p];
        before[p] = now[p];
        now[p] = next;
#pragma GCC unroll 8
        for (int i = 0; i < nv; ++i) {
          if (m < s) v[i][p] += P(w.v_series[i][m + 1]) * next;
          if (turned || i < nq) q[i][p] += P(w.q_series[i][m + 1]) * next;
        }
      }
    }
    for (int l = 0; l < count; ++l, rows += row) {
      const int p = l / lanes, lane = l % lanes;
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        rows[motions.of[i].velocity] = v[i][p][lane];
        if (i < nq) {
          rows[motions.of[i].position] = q[i][p][lane];
        } else if (turned && turns(w, i)) {
          rows[n] = q[i][p][lane];
        }
      }
    }
  }
};

}  // namespace bbsim::solve::radau
