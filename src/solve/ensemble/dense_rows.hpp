// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Output rows of one case of a group within a step, from the step's polynomials.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/ensemble/workspace.hpp"

namespace bbsim::solve::ensemble {

template <class Of>
struct DenseRows : Of {
  using Of::lanes, Of::packs, Of::places, Of::s;
  using typename Of::Courses, typename Of::P, typename Of::Workspace;

  // One lane's step: its start, inverse length, and the Chebyshev coefficients of x and y.
  // Chebyshev series have the shortest recurrence, T_(m+1) = 2 x T_m - T_(m-1).
  struct Series {
    double from, per_length, of[s + 2][2];
  };

  // The Legendre polynomial P_n is the sum of parts.of[n][m] T_m. With cos t = x, the generating
  // function of P_n is ((1 - z e^(i t)) (1 - z e^(-i t)))^(-1/2). The parts are therefore products
  // of coefficients of (1 - z)^(-1/2).
  struct Parts {
    double of[s + 2][s + 2]{};
    consteval Parts() {
      double root[s + 2] = {1};
      for (int j = 1; j < s + 2; ++j) root[j] = root[j - 1] * (2 * j - 1) / (2 * j);
      for (int n = 0; n < s + 2; ++n) {
        for (int m = n; m >= 0; m -= 2) {
          of[n][m] = (m > 0 ? 2 : 1) * root[(n - m) / 2] * root[(n + m) / 2];
        }
      }
    }
  };
  static constexpr Parts parts{};

  BBSIM_INLINE static Series series_of(const Workspace& w, int lane) {
    Series series;
    series.from = w.spans.from[lane];
    series.per_length = 1 / w.spans.length[lane];
    for (int m = 0; m < s + 2; ++m) {
      for (int i = 0; i < 2; ++i) series.of[m][i] = w.of[lane / lanes].series[m][i].v[lane % lanes];
    }
    return series;
  }

  [[gnu::flatten]] static void make_series(Workspace& w) {
    if (w.series) return;
    w.series = true;
    Of::template make_courses<places>(w);
    for (int p = 0; p < packs; ++p) {
      const Courses& courses = w.of[p].courses[places];
#pragma GCC unroll 1
      for (int m = 0; m < s + 2; ++m) {
        P sum[2] = {P(0.0), P(0.0)};
#pragma GCC unroll 1
        for (int n = m; n < s + 2; n += 2) {
          for (int i = 0; i < 2; ++i) sum[i] += P(parts.of[n][m]) * courses.q[i][n];
        }
        for (int i = 0; i < 2; ++i) w.of[p].series[m][i] = sum[i];
      }
    }
  }

  // Evaluates `together` packs of times. Several packs at once hide the latency of the recurrence.
  template <int together>
  BBSIM_INLINE static void put_rows(const Series& series, const double* times, double* x,
                                    double* y) {
    P twice[together], before[together], now[together], sum_x[together], sum_y[together];
#pragma GCC unroll 4
    for (int l = 0; l < together; ++l) {
      const P part = (P::load_anywhere(times + l * lanes) - P(series.from)) * P(series.per_length);
      before[l] = P(1.0);
      now[l] = P(2.0) * part - P(1.0);
      twice[l] = now[l] + now[l];
      sum_x[l] = P(series.of[0][0]) + P(series.of[1][0]) * now[l];
      sum_y[l] = P(series.of[0][1]) + P(series.of[1][1]) * now[l];
    }
#pragma GCC unroll 1
    for (int m = 2; m < s + 2; ++m) {
      const P of_x(series.of[m][0]), of_y(series.of[m][1]);
#pragma GCC unroll 4
      for (int l = 0; l < together; ++l) {
        const P next = twice[l] * now[l] - before[l];
        before[l] = now[l];
        now[l] = next;
        sum_x[l] += of_x * next;
        sum_y[l] += of_y * next;
      }
    }
#pragma GCC unroll 4
    for (int l = 0; l < together; ++l) {
      sum_x[l].store_anywhere(x + l * lanes);
      sum_y[l].store_anywhere(y + l * lanes);
    }
  }

  [[gnu::flatten]] static void evaluate(void* workspace, int lane, const double* times,
                                        std::size_t count, double* x, double* y) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    make_series(w);
    const Series series = series_of(w, lane);
    for (std::size_t i = 0; i < count;) {
      const std::size_t left = count - i;
      const double* const at = times + i;
      if (left > 2 * lanes) {
        put_rows<4>(series, at, x + i, y + i);
        i += 4 * lanes;
      } else if (left > lanes) {
        put_rows<2>(series, at, x + i, y + i);
        i += 2 * lanes;
      } else {
        put_rows<1>(series, at, x + i, y + i);
        i += lanes;
      }
    }
  }

  [[gnu::flatten]] static double squared_errors(const Case& of, const double* times,
                                                std::size_t count, const double* x,
                                                const double* y) {
    P total(0.0);
    for (std::size_t first = 0; first < count; first += lanes) {
      const P t = P::load_anywhere(times + first);
      P from[2] = {P::load_anywhere(x + first), P::load_anywhere(y + first)};
      for (int i = 0; i < 2; ++i) from[i] -= P(of.start[i]) + P(of.rate[i]) * t;
      for (int k = 0; k < of.harmonic_count; ++k) {
        const model::Harmonic& harmonic = of.harmonics[k];
        const P angle = P(harmonic.frequency) * t;
        const bool moderate = size_of(harmonic.frequency * times[count - 1]) < 1e5;
        const SinCos<P> wave = moderate ? sin_cos_of_moderate(angle) : sin_cos(angle);
        for (int i = 0; i < 2; ++i) {
          from[i] -= P(harmonic.sine[i]) * wave.sin + P(harmonic.cosine[i]) * wave.cos;
        }
      }
      P squared = from[0] * from[0] + from[1] * from[1];
      for (std::size_t l = count - first; l < lanes; ++l) squared.v[l] = 0;
      total += squared;
    }
    return sum(total);
  }
};

}  // namespace bbsim::solve::ensemble
