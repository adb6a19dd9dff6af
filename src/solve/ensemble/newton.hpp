// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Newton's iteration for the accelerations at the nodes of a step, with one case in each lane.
//
// The eigenvectors of Radau IIA's matrix split the system for all nodes into complex systems of
// four unknowns, one for each pair of eigenvalues.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/node_rows.hpp"
#include "solve/ensemble/equations.hpp"

namespace bbsim::solve::ensemble {

template <class Isa, Actuation actuation, int nodes>
struct Newton : Equations<Isa, actuation> {
  using Base = Equations<Isa, actuation>;
  using Base::nq, Base::nv, Base::x, Base::y, Base::phi, Base::theta, Base::spin;
  using typename Base::P, typename Base::Jacobian, typename Base::Signals;
  static constexpr int s = nodes;
  // The velocities whose accelerations are unknown, and how many of them have a position.
  static constexpr int unknown[] = {x, y, phi, theta, spin};
  static constexpr int with_position = 4;
  static constexpr const auto& rule = radau::radau_table<Isa, s>;
  static constexpr int pairs = s / 2;

  struct alignas(64) Rows : NodeRows<Isa, s> {
    double lambda_re[pairs]{}, lambda_im[pairs]{};
    double forward_re[s][pairs]{}, forward_im[s][pairs]{};
    double back_re[s][pairs]{}, back_im[s][pairs]{};
    consteval Rows() {
      for (int k = 0; k < pairs; ++k) {
        lambda_re[k] = rule.lambda_re[k];
        lambda_im[k] = rule.lambda_im[k];
        for (int i = 0; i < s; ++i) {
          forward_re[i][k] = rule.forward_re[i][k];
          forward_im[i][k] = rule.forward_im[i][k];
          back_re[i][k] = rule.back_re[k][i];
          back_im[i][k] = rule.back_im[k][i];
        }
      }
    }
  };
  static constexpr Rows rows{};

  // A complex number in each lane.
  struct Complex {
    P re, im;
    BBSIM_INLINE friend Complex operator*(const Complex& a, const Complex& b) {
      return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    BBSIM_INLINE friend Complex operator-(const Complex& a, const Complex& b) {
      return {a.re - b.re, a.im - b.im};
    }
  };
  struct Memory {
    Complex lu[pairs][nq][nq], transformed[pairs][nq];
    P residual[s][nq];
    Signals reference[s];
  };

  // Elimination starts with the servo's axes, which are the stiffest, and does not pivot.
  static constexpr int order[nq] = {phi, theta, x, y};

  // Makes I - Jk - h l Jv - h^2 l^2 Jq for each eigenvalue l, with rows and columns in `order`, and
  // factors it in place (LU). The diagonal is stored inverted.
  BBSIM_INLINE static void factor(const Jacobian& at, P h, Memory& of) {
#pragma GCC unroll 1
    for (int k = 0; k < pairs; ++k) {
      const P re1 = h * P(rows.lambda_re[k]), im1 = h * P(rows.lambda_im[k]);
      const P re2 = re1 * re1 - im1 * im1, im2 = P(2.0) * re1 * im1;
      auto& m = of.lu[k];
#pragma GCC unroll 8
      for (int i = 0; i < nq; ++i) {
#pragma GCC unroll 8
        for (int j = 0; j < nq; ++j) {
          const P by_v = at.by_v[order[i]][order[j]], by_q = at.by_q[order[i]][order[j]];
          P part(i == j ? 1.0 : 0.0);
          if (order[i] < phi && order[j] >= phi) part -= at.by_turning[order[i]][order[j] - phi];
          m[i][j] = {part - re1 * by_v - re2 * by_q, -(im1 * by_v) - im2 * by_q};
        }
      }
#pragma GCC unroll 8
      for (int p = 0; p < nq; ++p) {
        const P scale = P(1.0) / (m[p][p].re * m[p][p].re + m[p][p].im * m[p][p].im);
        m[p][p] = {m[p][p].re * scale, -(m[p][p].im * scale)};
#pragma GCC unroll 8
        for (int i = p + 1; i < nq; ++i) {
          m[i][p] = m[i][p] * m[p][p];
#pragma GCC unroll 8
          for (int j = p + 1; j < nq; ++j) m[i][j] = m[i][j] - m[i][p] * m[p][j];
        }
      }
    }
  }

  BBSIM_INLINE static void substitute(const Complex (&m)[nq][nq], Complex (&z)[nq]) {
#pragma GCC unroll 8
    for (int i = 1; i < nq; ++i) {
#pragma GCC unroll 8
      for (int j = 0; j < i; ++j) z[i] = z[i] - m[i][j] * z[j];
    }
#pragma GCC unroll 8
    for (int i = nq - 1; i >= 0; --i) {
#pragma GCC unroll 8
      for (int j = i + 1; j < nq; ++j) z[i] = z[i] - m[i][j] * z[j];
      z[i] = z[i] * m[i][i];
    }
  }

  // Adds Newton's correction for the residuals to k.
  BBSIM_INLINE static void correct(Memory& of, const P (&residual)[s][nq],
                                   P (&accelerations)[s][nv]) {
    constexpr int together = 2;
    static_assert(pairs % together == 0 && s % together == 0);
#pragma GCC unroll 1
    for (int first = 0; first < pairs; first += together) {
      Complex sum[together][nq];
#pragma GCC unroll 2
      for (int k = 0; k < together; ++k) {
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) sum[k][i] = {P(0.0), P(0.0)};
      }
#pragma GCC unroll 2
      for (int j = 0; j < s; ++j) {
#pragma GCC unroll 2
        for (int k = 0; k < together; ++k) {
          const P re(rows.forward_re[j][first + k]), im(rows.forward_im[j][first + k]);
#pragma GCC unroll 8
          for (int i = 0; i < nq; ++i) {
            sum[k][i].re += re * residual[j][order[i]];
            sum[k][i].im += im * residual[j][order[i]];
          }
        }
      }
#pragma GCC unroll 2
      for (int k = 0; k < together; ++k) {
        substitute(of.lu[first + k], sum[k]);
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) of.transformed[first + k][order[i]] = sum[k][i];
      }
    }
#pragma GCC unroll 1
    for (int first = 0; first < s; first += together) {
      P sum[together][nq];
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) sum[j][i] = accelerations[first + j][i];
      }
#pragma GCC unroll 2
      for (int k = 0; k < pairs; ++k) {
#pragma GCC unroll 2
        for (int j = 0; j < together; ++j) {
          const P re(rows.back_re[first + j][k]), im(rows.back_im[first + j][k]);
#pragma GCC unroll 8
          for (int i = 0; i < nq; ++i) {
            sum[j][i] += re * of.transformed[k][i].re;
            sum[j][i] += im * of.transformed[k][i].im;
          }
        }
      }
#pragma GCC unroll 2
      for (int j = 0; j < together; ++j) {
#pragma GCC unroll 8
        for (int i = 0; i < nq; ++i) accelerations[first + j][i] = sum[j][i];
      }
    }
  }
};

}  // namespace bbsim::solve::ensemble
