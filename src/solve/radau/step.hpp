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

#include "simd/compare.hpp"
#include "simd/dual.hpp"
#include "solve/collocation/convergence.hpp"
#include "solve/collocation/radau_table.hpp"
#include "solve/radau/kernel.hpp"

namespace bbsim::solve::radau {

using simd::larger_of, simd::size_of;

template <class T>
const T& instance();  // for its type only

template <int count, int lanes>
inline constexpr int padded = (count + lanes - 1) / lanes* lanes;

// The tables of RadauTable, aligned and padded to whole packs. Padding stages repeat the last
// stage; padding eigenvalues are zero.
template <class Isa, int s>
struct alignas(64) PackedTable {
  static constexpr int stages = padded<s, Isa::lanes>;
  static constexpr int eigen_lanes = Isa::lanes == 8 && s == 8 ? 4 : Isa::lanes;
  static constexpr int pairs = padded<s / 2, eigen_lanes>;
  alignas(64) double c[stages]{};
  alignas(64) double lambda_re[pairs]{}, lambda_im[pairs]{};
  alignas(64) double a[s][stages]{}, a_squared[s][stages]{}, legendre[s][stages]{};
  alignas(64) double forward_re[s][pairs]{}, forward_im[s][pairs]{};
  alignas(64) double back_re[s / 2][stages]{}, back_im[s / 2][stages]{};

  consteval PackedTable() {
    constexpr const auto& of = radau_table<Isa, s>;
    for (int i = 0; i < stages; ++i) {
      const int from = i < s ? i : s - 1;
      c[i] = of.c[from];
      for (int j = 0; j < s; ++j) {
        a[j][i] = of.a[j][from];
        a_squared[j][i] = of.a_squared[j][from];
        legendre[j][i] = of.legendre[j][from];
      }
      for (int k = 0; k < s / 2; ++k) {
        back_re[k][i] = of.back_re[k][from];
        back_im[k][i] = of.back_im[k][from];
      }
    }
    for (int k = 0; k < s / 2; ++k) {
      lambda_re[k] = of.lambda_re[k];
      lambda_im[k] = of.lambda_im[k];
      for (int j = 0; j < s; ++j) {
        forward_re[j][k] = of.forward_re[j][k];
        forward_im[j][k] = of.forward_im[j][k];
      }
    }
  }
};

// The parts of a step that depend on the layout of the states but not on the system. The long
// functions are noinline, because compiling them again for each system would take twice as long.
// Functions stay inline if noinline would change results: which of two products in a sum is fused
// may depend on the surrounding code.
//
// The accelerations first_turning to first_turning + turning - 1 are arguments of the system's own
// right-hand side.
template <class Isa, auto state_motions, int n, int first_turning, int turning, int s>
struct Collocation {
  using Table = PackedTable<Isa, s>;
  static constexpr Table table{};
  static constexpr auto motions = state_motions;
  static constexpr int nv = motions.count;
  static constexpr int nq = n - nv;  // velocities with a position come first
  static constexpr int lanes = Isa::lanes;
  static constexpr int packs = Table::stages / lanes;
  static constexpr int eigen_packs = Table::pairs / Table::eigen_lanes;
  using P = simd::Pack<Isa, lanes>;
  using E = simd::Pack<Isa, Table::eigen_lanes>;

  // One value per stage, for each velocity or position.
  template <int rows>
  struct alignas(64) Stages {
    double of[rows][Table::stages];
  };

  struct alignas(64) Workspace : WorkspaceHead {
    double contraction;   // of the last step's iteration
    double t, h;          // of the last attempt
    double q[nv], v[nv];  // present state; q of a velocity without position is its integral
    double q_weight[nv], v_weight[nv];
    Stages<nv> k, f, v_stage, series;  // series: Legendre coefficients of k
    Stages<nv> q_stage;
    double jv[nv][nv], jq[nv][nv], jk[nv][turning + 1];
    E m_re[eigen_packs][nv][nv], m_im[eigen_packs][nv][nv];
    alignas(64) double r_re[nv][Table::pairs], r_im[nv][Table::pairs];
    double q_series[nv][s + 2], v_series[nv][s + 1];  // in scaled Legendre polynomials
  };

  // out[v][i] = sum_j column[j][i] in[v][j]. Passes each pack of the result to `finish`.
  template <int rows, int length, int width, class Result, class Finish>
  BBSIM_INLINE static void apply(const double (&column)[length][width], const double* in,
                                 int in_stride, Finish finish) {
    constexpr int size = Result::size;
    constexpr int total = width / size;
    constexpr int block = rows >= 4 ? (total < 2 ? total : 2) : (total < 4 ? total : 4);
    static_assert(total % block == 0 || block == 2 || block == 4);
#pragma GCC unroll 8
    for (int p0 = 0; p0 < total; p0 += block) {
      Result sum[rows][block];
#pragma GCC unroll 8
      for (int v = 0; v < rows; ++v) {
#pragma GCC unroll 4
        for (int p = 0; p < block; ++p) sum[v][p] = Result(0.0);
      }
#pragma GCC unroll 2
      for (int j = 0; j < length; ++j) {
#pragma GCC unroll 4
        for (int p = 0; p < block; ++p) {
          if (p0 + p >= total) continue;
          const Result a = Result::load(&column[j][(p0 + p) * size]);
#pragma GCC unroll 8
          for (int v = 0; v < rows; ++v) sum[v][p] += a * Result(in[v * in_stride + j]);
        }
      }
#pragma GCC unroll 8
      for (int v = 0; v < rows; ++v) {
#pragma GCC unroll 4
        for (int p = 0; p < block; ++p) {
          if (p0 + p < total) finish(v, p0 + p, sum[v][p]);
        }
      }
    }
  }

  // Computes v and q at the stages from k. Returns the weighted mean square of their change.
  template <bool measured>
  BBSIM_INLINE static double integrate_stages(Workspace& w) {
    P change[4] = {P(0.0), P(0.0), P(0.0), P(0.0)};
    const double h = w.h;
    apply<nv, s, Table::stages, P>(table.a, w.k.of[0], Table::stages, [&](int i, int p, P sum) {
      double* const target = &w.v_stage.of[i][p * lanes];
      const P value = P(w.v[i]) + h * sum;
      if constexpr (measured) {
        const P scaled = (value - P::load(target)) * P(w.v_weight[i]);
        change[i & 3] += scaled * scaled;
      }
      value.store(target);
    });
    apply<nq, s, Table::stages, P>(
        table.a_squared, w.k.of[0], Table::stages, [&](int i, int p, P sum) {
          double* const target = &w.q_stage.of[i][p * lanes];
          const P value =
              P(w.q[i]) + (P(h) * P::load(&table.c[p * lanes]) * P(w.v[i]) + (h * h) * sum);
          if constexpr (measured) {
            const P scaled = (value - P::load(target)) * P(w.q_weight[i]);
            change[i & 3] += scaled * scaled;
          }
          value.store(target);
        });
    return sum((change[0] + change[1]) + (change[2] + change[3])) / Table::stages;
  }

  // Makes the matrices I - Jk - h l Jv - h^2 l^2 Jq for all eigenvalues l, and factors them in
  // place without pivoting (LU). The diagonal is stored inverted.
  [[gnu::noinline]] static void factor(Workspace& w) {
    for (int e = 0; e < eigen_packs; ++e) {
      const E re = w.h * E::load(&table.lambda_re[e * E::size]);
      const E im = w.h * E::load(&table.lambda_im[e * E::size]);
      const E re2 = re * re - im * im;
      const E im2 = 2.0 * (re * im);
      auto& a = w.m_re[e];
      auto& b = w.m_im[e];
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
#pragma GCC unroll 8
        for (int j = 0; j < nv; ++j) {
          E x = E(i == j ? 1.0 : 0.0) - re * E(w.jv[i][j]);
          if (j >= first_turning && j < first_turning + turning) {
            x -= E(w.jk[i][j - first_turning]);
          }
          E y = -(im * E(w.jv[i][j]));
          if (j < nq) {
            x -= re2 * E(w.jq[i][j]);
            y -= im2 * E(w.jq[i][j]);
          }
          a[i][j] = x;
          b[i][j] = y;
        }
      }
#pragma GCC unroll 8
      for (int k = 0; k < nv; ++k) {
        const E scale = E(1.0) / (a[k][k] * a[k][k] + b[k][k] * b[k][k]);
        const E pr = a[k][k] * scale, pi = -(b[k][k] * scale);
        a[k][k] = pr;
        b[k][k] = pi;
#pragma GCC unroll 8
        for (int i = k + 1; i < nv; ++i) {
          const E lr = a[i][k] * pr - b[i][k] * pi, li = a[i][k] * pi + b[i][k] * pr;
          a[i][k] = lr;
          b[i][k] = li;
#pragma GCC unroll 8
          for (int j = k + 1; j < nv; ++j) {
            a[i][j] = (a[i][j] - lr * a[k][j]) + li * b[k][j];
            b[i][j] = (b[i][j] - lr * b[k][j]) - li * a[k][j];
          }
        }
      }
    }
  }

  // Adds the Newton correction to k. Overwrites f with the residual f - k.
  [[gnu::noinline]] static void correct(Workspace& w) {
    for (int i = 0; i < nv; ++i) {
      for (int p = 0; p < packs; ++p) {
        double* const f = &w.f.of[i][p * lanes];
        (P::load(f) - P::load(&w.k.of[i][p * lanes])).store(f);
      }
    }
    apply<nv, s, Table::pairs, E>(table.forward_re, w.f.of[0], Table::stages,
                                  [&](int i, int p, E x) { x.store(&w.r_re[i][p * E::size]); });
    apply<nv, s, Table::pairs, E>(table.forward_im, w.f.of[0], Table::stages,
                                  [&](int i, int p, E x) { x.store(&w.r_im[i][p * E::size]); });
#pragma GCC unroll 1
    for (int e = 0; e < eigen_packs; ++e) {
      const auto& a = w.m_re[e];
      const auto& b = w.m_im[e];
      E x[nv], y[nv];
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        x[i] = E::load(&w.r_re[i][e * E::size]);
        y[i] = E::load(&w.r_im[i][e * E::size]);
#pragma GCC unroll 8
        for (int j = 0; j < i; ++j) {
          x[i] = (x[i] - a[i][j] * x[j]) + b[i][j] * y[j];
          y[i] = (y[i] - a[i][j] * y[j]) - b[i][j] * x[j];
        }
      }
#pragma GCC unroll 8
      for (int i = nv - 1; i >= 0; --i) {
#pragma GCC unroll 8
        for (int j = i + 1; j < nv; ++j) {
          x[i] = (x[i] - a[i][j] * x[j]) + b[i][j] * y[j];
          y[i] = (y[i] - a[i][j] * y[j]) - b[i][j] * x[j];
        }
        const E re = a[i][i] * x[i] - b[i][i] * y[i];
        y[i] = a[i][i] * y[i] + b[i][i] * x[i];
        x[i] = re;
        x[i].store(&w.r_re[i][e * E::size]);
        y[i].store(&w.r_im[i][e * E::size]);
      }
    }
    apply<nv, s / 2, Table::stages, P>(table.back_re, w.r_re[0], Table::pairs,
                                       [&](int i, int p, P sum) {
                                         double* const k = &w.k.of[i][p * lanes];
                                         (P::load(k) + sum).store(k);
                                       });
    apply<nv, s / 2, Table::stages, P>(table.back_im, w.r_im[0], Table::pairs,
                                       [&](int i, int p, P sum) {
                                         double* const k = &w.k.of[i][p * lanes];
                                         (P::load(k) + sum).store(k);
                                       });
  }

  // Sets the first guess of k, and v and q at the stages, for the step at w.t of length w.h:
  // accelerations stay constant over the step.
  BBSIM_INLINE static void hold(Workspace& w, const double (&k)[nv]) {
    for (int p = 0; p < packs; ++p) {
      const P time = w.h * P::load(&table.c[p * lanes]);
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        const P gain = time * P(k[i]);
        P(k[i]).store(&w.k.of[i][p * lanes]);
        (P(w.v[i]) + gain).store(&w.v_stage.of[i][p * lanes]);
        if (i >= nq) continue;
        const P q = P(w.q[i]) + time * (P(w.v[i]) + 0.5 * gain);
        q.store(&w.q_stage.of[i][p * lanes]);
      }
    }
  }

  // Sets the same from the polynomial of the rejected, longer attempt at t of length h.
  [[gnu::noinline]] static void extrapolate(Workspace& w, double t, double h) {
    for (int p = 0; p < packs; ++p) {
      const P x = (2 * (w.t - t) / h - 1) + (2 * w.h / h) * P::load(&table.c[p * lanes]);
      P value[nv], before = P(1.0), now = x;
      for (int i = 0; i < nv; ++i) value[i] = w.series.of[i][0] + w.series.of[i][1] * x;
      for (int m = 1; m + 1 < s; ++m) {
        const P next = ((2.0 * m + 1) / (m + 1)) * x * now - (double(m) / (m + 1)) * before;
        before = now;
        now = next;
        for (int i = 0; i < nv; ++i) value[i] += P(w.series.of[i][m + 1]) * now;
      }
      for (int i = 0; i < nv; ++i) value[i].store(&w.k.of[i][p * lanes]);
    }
    integrate_stages<false>(w);
  }

  static void weigh(Workspace& w) {
    for (int i = 0; i < nv; ++i) {
      w.v_weight[i] = 1 / (w.rtol * size_of(w.v[i]) + w.atol);
      w.q_weight[i] = 1 / (w.rtol * size_of(w.q[i]) + w.atol);
    }
  }

  static void prepare(Workspace& w, const Start& from) {
    w.rtol = from.rtol;
    w.atol = from.atol;
    w.gamma = from.gamma;
    w.positions_only = from.positions_only;
    w.has_guess = false;
    w.accepted = false;
    w.contraction = 1;
    w.t = w.h = 0;
    for (int i = 0; i < nv; ++i) {
      w.v[i] = from.state[motions.of[i].velocity];
      w.q[i] = i < nq ? from.state[motions.of[i].position] : 0.0;
    }
    for (int i = 0; i < nv; ++i) {
      for (double& term : w.q_series[i]) term = 0;
    }
    weigh(w);
  }

  // Whether gamma is wanted and velocity i is the spin, the first velocity without a position.
  BBSIM_INLINE static bool turns(const Workspace& w, int i) {
    return i == nq && w.gamma;
  }

  // The rounding error of acceleration i, which a shorter step would not reduce. It is the smaller
  // of two bounds: the rounding of the right-hand side, and the rounding of the position
  // differentiated twice. The second holds if a stiff equation ties the acceleration to the
  // position.
  static double noise(const Workspace& w, int i) {
    if (!w.newton || i >= nq) return 0;
    double from_rates = 0;
    for (int j = 0; j < nv; ++j) {
      from_rates += size_of(w.jv[i][j] * w.v[j]);
      if (j < nq) from_rates += size_of(w.jq[i][j] * w.q[j]);
    }
    const double twice = (s * s) / w.h;
    const double from_position = twice * twice * (size_of(w.q[i]) + size_of(w.h * w.v[i]));
    double from_turning = 0;
    if (i < first_turning) {
      for (int m = 0; m < turning; ++m) {
        from_turning += size_of(w.jk[i][m]) * noise(w, first_turning + m);
      }
    }
    return 2.2e-16 * (from_rates < from_position ? from_rates : from_position) + from_turning;
  }

  // Computes the Legendre coefficients of k, `series`, and the error. The decay of the last
  // coefficients predicts the first coefficient left out. The error is its integral for a velocity,
  // and its second integral for a position.
  [[gnu::noinline]] static void estimate(Workspace& w, Attempt& a) {
    apply<nv, s, Table::stages, P>(
        table.legendre, w.k.of[0], Table::stages,
        [&](int i, int p, P sum) { sum.store(&w.series.of[i][p * lanes]); });
    const double once = size_of(w.h) / (2 * s + 1);
    for (int i = 0; i < nv; ++i) {
      const double* const k = w.series.of[i];
      const double tail = larger_of(size_of(k[s - 2]), size_of(k[s - 1]));
      const double before = larger_of(size_of(k[s - 4]), size_of(k[s - 3]));
      double left_out = tail < before ? tail * __builtin_sqrt(tail / before) : tail;
      left_out = larger_of(left_out - noise(w, i), 0);
      const double v_scale =
          w.rtol * larger_of(size_of(w.v_stage.of[i][s - 1]), size_of(w.v[i])) + w.atol;
      const double v_error = once * left_out / v_scale;
      if (!(v_error <= a.error)) {
        a.error = v_error;
        a.worst_state = motions.of[i].velocity;
      }
      if (i < nq || turns(w, i)) {
        const double reached = i < nq ? w.q_stage.of[i][s - 1] : 0.0;
        const double q_scale = w.rtol * larger_of(size_of(reached), size_of(w.q[i])) + w.atol;
        const double q_error = once * once * left_out / q_scale;
        if (q_error > a.error) {
          a.error = q_error;
          a.worst_state = i < nq ? motions.of[i].position : motions.of[i].velocity;
        }
      }
    }
  }

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

  static void accept(void* workspace) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    for (int i = 0; i < nv; ++i) {
      if (i < nq) {
        w.q[i] = w.q_stage.of[i][s - 1];
      } else if (turns(w, i)) {
        // The double integral over the step: q + h v + (h/2)^2 times that of the series.
        const double* const k = w.series.of[i];
        w.q[i] += w.h * (w.v[i] + w.h / 2 * (k[0] - k[1] / 3));
      }
      w.v[i] = w.v_stage.of[i][s - 1];
    }
    w.accepted = true;
    weigh(w);
  }

  static void evaluate(void* workspace, const double* times, std::size_t count, double* rows) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    expand(w);
    if (w.gamma) {
      evaluate_rows<true, true>(w, times, count, rows);
    } else if (w.positions_only) {
      evaluate_rows<false, false>(w, times, count, rows);
    } else {
      evaluate_rows<true, false>(w, times, count, rows);
    }
  }

  // Expands velocities and positions into series. All callers share this function, so that all get
  // the same fused products.
  [[gnu::noinline]] static void expand(Workspace& w) {
    const double half = w.h / 2;
    for (int i = 0; i < nv; ++i) {
      integrate_series<s, false>(w.series.of[i], half, w.v[i], w.v_series[i]);
      if (i < nq || turns(w, i)) {
        integrate_series<s + 1, true>(w.v_series[i], half, w.q[i], w.q_series[i]);
      }
    }
  }

  // Positions are the same bit for bit, with or without velocities and the integral of u, and for
  // any number of times.
  template <bool velocities, bool turned>
  BBSIM_INLINE static void evaluate_rows(Workspace& w, const double* times, std::size_t count,
                                         double* rows) {
    constexpr int row = n + (turned ? 1 : 0);
    // Evaluates two packs of times at once to hide the latency of the recurrence.
    while (count > lanes) {
      const std::size_t some = count < 2 * lanes ? count : 2 * lanes;
      evaluate_some<velocities, turned, 2>(w, times, static_cast<int>(some), rows);
      times += some;
      rows += some * row;
      count -= some;
    }
    if (count > 0) {
      evaluate_some<velocities, turned, 1>(w, times, static_cast<int>(count), rows);
    }
  }

  template <bool velocities, bool turned, int together>
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
        if (velocities) v[i][p] = w.v_series[i][0] + w.v_series[i][1] * x[p];
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
          if (velocities && m < s) v[i][p] += P(w.v_series[i][m + 1]) * next;
          if (turned || i < nq) q[i][p] += P(w.q_series[i][m + 1]) * next;
        }
      }
    }
    for (int l = 0; l < count; ++l, rows += row) {
      const int p = l / lanes, lane = l % lanes;
#pragma GCC unroll 8
      for (int i = 0; i < nv; ++i) {
        if (velocities) rows[motions.of[i].velocity] = v[i][p][lane];
        if (i < nq) {
          rows[motions.of[i].position] = q[i][p][lane];
        } else if (turned && turns(w, i)) {
          rows[n] = q[i][p][lane];
        }
      }
    }
  }

  static void state(const void* workspace, double* z) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int i = 0; i < nv; ++i) {
      z[motions.of[i].velocity] = w.v[i];
      if (i < nq) z[motions.of[i].position] = w.q[i];
    }
  }
};

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

template <class Isa, class System, int s>
struct Step
    : Collocation<Isa, System::motions, System::size, SystemRates<Isa, System>::first_turning,
                  SystemRates<Isa, System>::turning, s> {
  using Rates = SystemRates<Isa, System>;
  static constexpr int turning = Rates::turning, first_turning = Rates::first_turning;
  using Base = Collocation<Isa, System::motions, System::size, first_turning, turning, s>;
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
