// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Algebraic Riccati equations, by structured doubling.
#pragma once

#include <Eigen/Core>

#include "model/control/linear_system.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// Both solvers:
//   A is n x n, B n x m, Q n x n and symmetric positive semidefinite, R m x m and symmetric
//   positive definite, in the caller's units. Only the result is checked. (A, B) must be
//   stabilizable, and (A, Q) must have no unobservable mode that does not decay. Otherwise no
//   stabilizing solution exists, and they throw a KeyError of controller.lqr.
struct RiccatiSolution {
  Eigen::MatrixXd cost;  // X, n x n: z^T X z is the cost from z on
  Eigen::MatrixXd gain;  // K, m x n, of u = -K z, which stabilizes the loop
};

// A^T X A - X - A^T X B (R + B^T X B)^-1 B^T X A + Q = 0 and K = (R + B^T X B)^-1 B^T X A, which
// minimizes the sum of z^T Q z + u^T R u over the steps z+ = A z + B u.
// Method: Chu, Fan, Lin and Wang, Int. J. Control 77 (2004).
[[nodiscard]] RiccatiSolution solve_discrete_riccati(const Eigen::MatrixXd& a,
                                                     const Eigen::MatrixXd& b,
                                                     const Eigen::MatrixXd& q,
                                                     const Eigen::MatrixXd& r);

// A^T X + X A - X B R^-1 B^T X + Q = 0 and K = R^-1 B^T X, which minimizes the integral of
// z^T Q z + u^T R u under z' = A z + B u.
// Method: a Cayley transform to the discrete one; Chu, Fan and Lin, Linear Algebra Appl. 396
// (2005).
[[nodiscard]] RiccatiSolution solve_continuous_riccati(const Eigen::MatrixXd& a,
                                                       const Eigen::MatrixXd& b,
                                                       const Eigen::MatrixXd& q,
                                                       const Eigen::MatrixXd& r);

// The gain K of Law::lqr, u = K (reference - z), rows phi, theta, with z as in plant_at_home().
// Weights are the diagonals of Q and R. `period` (s) > 0 is that of a sampled loop, whose delays
// the gain ignores; 0 is continuous time. Throws InputError if no gain stabilizes the plant.
[[nodiscard]] Eigen::Matrix<double, 2, 8> lqr_gain(const LinearPlant& plant,
                                                   const LqrWeights& weights, double period);

}  // namespace bbsim::model
