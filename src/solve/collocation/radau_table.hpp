// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The constants of Radau IIA collocation, computed by the compiler in quad precision.
//
// In Legendre polynomials integration is tridiagonal: on [0, 1] the integral of P_j is
// (P_(j+1) - P_(j-1)) / (2 (2 j + 1)). The nodes are the roots of P_s - P_(s-1), so P_s counts as
// P_(s-1) there. Eigenvalues and eigenvectors follow from the recurrence of the rows.
#pragma once

#include "base/quad.hpp"

namespace bbsim::solve::radau {

// Matrices are stored by columns, the index of the result last: column[j][i]. Instruction sets must
// not share data, so each has tables of its own. Others use Shared.
struct Shared {};
template <class Isa, int s>
struct alignas(64) RadauTable {
  static constexpr int pairs = s / 2;

  double c[s]{};                                  // nodes
  double a[s][s]{}, a_squared[s][s]{};            // a integrates nodal values from 0 to the nodes
  double legendre[s][s]{};                        // nodal values -> shifted Legendre coefficients
  double lambda_re[pairs]{}, lambda_im[pairs]{};  // eigenvalues of a above the real axis
  // Nodal values -> coordinates in the eigenvectors. These and their conjugates -> nodal values.
  double forward_re[s][pairs]{}, forward_im[s][pairs]{};
  double back_re[pairs][s]{}, back_im[pairs][s]{};

  consteval RadauTable() {
    Quad x[s];  // the nodes on [-1, 1]
    find_nodes(x);
    Quad basis[s][s];     // P_j at the nodes
    Quad integral[s][s];  // its integral there
    Quad weighted[s][s];  // the share of node i in coefficient m
    for (int i = 0; i < s; ++i) {
      const Values p(x[i]);
      // Radau's quadrature, whose weights these are, is exact for products P_m P_n of degrees
      // below s.
      const Quad root = Quad(s) * p.of[s - 1], weight = (Quad(1.0) + x[i]) / (root * root);
      for (int m = 0; m < s; ++m) {
        basis[m][i] = p.of[m];
        weighted[i][m] = Quad(m + 0.5) * weight * p.of[m];
        legendre[i][m] = plain(weighted[i][m]);
      }
    }
    for (int j = 0; j < s; ++j) {
      for (int i = 0; i < s; ++i) {
        integral[j][i] = diagonal(j) * basis[j][i];
        if (j > 0) integral[j][i] += above(j - 1) * basis[j - 1][i];
        if (j + 1 < s) integral[j][i] += below(j) * basis[j + 1][i];
      }
    }
    Quad once[s][s];
    for (int j = 0; j < s; ++j) {
      for (int i = 0; i < s; ++i) {
        once[j][i] = Quad(0.0);
        for (int m = 0; m < s; ++m) once[j][i] += integral[m][i] * weighted[j][m];
        a[j][i] = plain(once[j][i]);
      }
    }
    for (int j = 0; j < s; ++j) {
      for (int i = 0; i < s; ++i) {
        Quad twice(0.0);
        for (int m = 0; m < s; ++m) twice += once[m][i] * once[j][m];
        a_squared[j][i] = plain(twice);
      }
    }
    for (int k = 0; k < pairs; ++k) find_eigenvector(k, weighted, basis);
  }

 private:
  struct Complex {
    Quad re{0.0}, im{0.0};
    friend constexpr Complex operator+(Complex p, Complex q) { return {p.re + q.re, p.im + q.im}; }
    friend constexpr Complex operator-(Complex p, Complex q) { return {p.re - q.re, p.im - q.im}; }
    friend constexpr Complex operator*(Quad p, Complex q) { return {p * q.re, p * q.im}; }
    friend constexpr Complex operator*(Complex p, Complex q) {
      return {p.re * q.re - p.im * q.im, p.re * q.im + p.im * q.re};
    }
    friend constexpr Complex operator/(Complex p, Complex q) {
      return (Quad(1.0) / (q.re * q.re + q.im * q.im)) * (p * Complex{q.re, -q.im});
    }
  };

  // P_0 to P_s and the derivative of P_s - P_(s-1) at x.
  struct Values {
    Quad of[s + 1], slope[s + 1];
    constexpr explicit Values(Quad x) {
      of[0] = slope[1] = Quad(1.0);
      slope[0] = Quad(0.0);
      of[1] = x;
      for (int m = 1; m < s; ++m) {
        of[m + 1] = (Quad(2 * m + 1) * x * of[m] - Quad(m) * of[m - 1]) / Quad(m + 1);
        slope[m + 1] = slope[m - 1] + Quad(2 * m + 1) * of[m];
      }
    }
  };

  // The integral of P_j in Legendre polynomials: its shares of P_j, of P_(j+1), and of P_j in the
  // integral of P_(j+1).
  static constexpr Quad diagonal(int j) {
    return j == 0 ? Quad(0.5) : j == s - 1 ? below(j) : Quad(0.0);
  }
  static constexpr Quad below(int j) { return Quad(1.0) / Quad(2 * (2 * j + 1)); }
  static constexpr Quad above(int j) { return -below(j + 1); }

  // Newton's iteration for the largest root that is left, from the right of it. All roots are real,
  // so it approaches from there.
  consteval void find_nodes(Quad (&x)[s]) {
    x[s - 1] = Quad(1.0);
    c[s - 1] = 1;
    for (int i = s - 2; i >= 0; --i) {
      Quad at(1.01);
      for (int iteration = 0; iteration < 60; ++iteration) {
        const Values p(at);
        const Quad value = p.of[s] - p.of[s - 1];
        Quad slope = p.slope[s] - p.slope[s - 1];
        for (int k = i + 1; k < s; ++k) slope -= value / (at - x[k]);
        const Quad step = value / slope;
        at -= step;
        if (abs(step) < Quad(1e-20)) break;  // the error is this one squared
      }
      x[i] = at;
      c[i] = plain((at + Quad(1.0)) / Quad(2.0));
    }
  }

  // The eigenvector of `lambda` in Legendre polynomials, and its derivative by lambda. `rest` is
  // what its last row leaves, which is 0 for an eigenvalue.
  struct Eigenvector {
    Complex of[s], by[s], rest, rest_by;
    constexpr explicit Eigenvector(Complex lambda) {
      of[0] = {Quad(1.0), Quad(0.0)};
      for (int j = 0; j < s; ++j) {
        const Complex left = Complex{diagonal(j), Quad(0.0)} - lambda;
        Complex sum = left * of[j], sum_by = left * by[j] - of[j];
        if (j > 0) {
          sum = sum + below(j - 1) * of[j - 1];
          sum_by = sum_by + below(j - 1) * by[j - 1];
        }
        if (j + 1 == s) {
          rest = sum;
          rest_by = sum_by;
        } else {
          const Quad scale = Quad(-1.0) / above(j);
          of[j + 1] = scale * sum;
          by[j + 1] = scale * sum_by;
        }
      }
    }
  };

  // The eigenvalues to a few digits, from the real axis outwards.
  static constexpr Complex guess(int k) {
    if constexpr (s == 8) {
      constexpr double re[] = {0.0958, 0.0831, 0.0595, 0.0282};
      constexpr double im[] = {0.0155, 0.0439, 0.0644, 0.0723};
      return {Quad(re[k]), Quad(im[k])};
    } else if constexpr (s == 12) {
      constexpr double re[] = {0.0638, 0.0599, 0.0525, 0.0420, 0.0289, 0.0138};
      constexpr double im[] = {0.0069, 0.0202, 0.0318, 0.0409, 0.0464, 0.0473};
      return {Quad(re[k]), Quad(im[k])};
    } else {
      static_assert(s == 16);
      constexpr double re[] = {0.0477, 0.0461, 0.0429, 0.0382, 0.0323, 0.0252, 0.0084, 0.0173};
      constexpr double im[] = {0.0039, 0.0115, 0.0185, 0.0248, 0.0299, 0.0335, 0.0349, 0.0354};
      return {Quad(re[k]), Quad(im[k])};
    }
  }

  consteval void find_eigenvector(int k, const Quad (&weighted)[s][s], const Quad (&basis)[s][s]) {
    Complex lambda = guess(k);
    for (int iteration = 0; iteration < 5; ++iteration) {
      const Eigenvector at(lambda);
      lambda = lambda - at.rest / at.rest_by;
    }
    lambda_re[k] = plain(lambda.re);
    lambda_im[k] = plain(lambda.im);
    // Integration is antisymmetric but for its corners, in polynomials of norm 1. So the entry j of
    // the left eigenvector is (-1)^j / (2 j + 1) times that of the right one.
    const Eigenvector right(lambda);
    Complex product, left[s];
    for (int j = 0; j < s; ++j) {
      left[j] = Quad((j % 2 == 0 ? 1.0 : -1.0)) / Quad(2 * j + 1) * right.of[j];
      product = product + left[j] * right.of[j];
    }
    for (int i = 0; i < s; ++i) {
      Complex to, from;
      for (int j = 0; j < s; ++j) {
        to = to + weighted[i][j] * left[j];
        from = from + basis[j][i] * right.of[j];
      }
      to = to / product;
      forward_re[i][k] = plain(to.re);
      forward_im[i][k] = plain(to.im);
      back_re[k][i] = plain(Quad(2.0) * from.re);
      back_im[k][i] = plain(Quad(-2.0) * from.im);
    }
  }
};

template <class Isa, int s>
inline constexpr RadauTable<Isa, s> radau_table{};

// The weight of each nodal value in the node polynomial's value at the start of the step.
template <int s>
struct StartWeights {
  double of[s]{};

  consteval StartWeights() {
    const auto& c = radau_table<Shared, s>.c;
    for (int j = 0; j < s; ++j) {
      of[j] = 1;
      for (int k = 0; k < s; ++k) {
        if (k != j) of[j] *= c[k] / (c[k] - c[j]);
      }
    }
  }
};

}  // namespace bbsim::solve::radau
