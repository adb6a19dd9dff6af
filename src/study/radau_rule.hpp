// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Radau IIA collocation with s stages, order 2s - 1, in quad precision.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/quad.hpp"

namespace bbsim::study {

// The tables of the method on the unit interval: Hairer and Wanner, Solving Ordinary Differential
// Equations II, IV.5. The collocation polynomial u has degree s and is given by its values at 0,
// c_1, ..., c_s = 1. The method is L-stable, so a stiff transient decays within a step. A Gauss
// method would carry its remainder along, and the steps could not grow.
struct RadauRule {
  // `s` is at least 2. Beyond 40 the barycentric weights lose digits.
  explicit RadauRule(int s);

  int stages;
  std::vector<Quad> nodes;           // c_i, increasing within (0, 1]
  std::vector<Quad> matrix;          // a_ij = integral of Lagrange's l_j from 0 to c_i, row-major
  Eigen::MatrixXd matrix_in_double;  // the same, rounded
  std::vector<Quad> barycentric;     // s + 1 weights of interpolation at 0, c_1, ..., c_s
  // Legendre coefficients of u from its increments u(c_i) - u(0): sum of row[i] (u(c_i) - u(0)).
  std::vector<Quad> last_coefficient;  // of degree s
  std::vector<Quad>
      previous_coefficient;  // of degree s - 1, of the polynomial through c_1, ..., c_s
  // Row k gives the Legendre coefficient of degree k < s from values at c_1, ..., c_s.
  std::vector<Quad> to_legendre;
};

// P_0(x), ..., P_{count - 1}(x).
void legendre(Quad x, int count, Quad* values);

}  // namespace bbsim::study
