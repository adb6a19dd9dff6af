// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The equations of a collocation step (step.hpp) for any system with a layout of states: the
// stages, Newton's corrections, and the error.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/compare.hpp"
#include "solve/radau/kernel.hpp"
#include "solve/radau/packed_table.hpp"

namespace bbsim::solve::radau {

using simd::larger_of, simd::size_of;

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
  static constexpr int states = n, nodes = s;
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
    w.has_guess = false;
    w.accepted = w.expanded = false;
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
    w.expanded = false;
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

  static void state(const void* workspace, double* z) {
    const Workspace& w = *static_cast<const Workspace*>(workspace);
    for (int i = 0; i < nv; ++i) {
      z[motions.of[i].velocity] = w.v[i];
      if (i < nq) z[motions.of[i].position] = w.q[i];
    }
  }
};

}  // namespace bbsim::solve::radau
