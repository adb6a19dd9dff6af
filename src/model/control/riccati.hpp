// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Algebraic Riccati equations, by structured doubling.
#pragma once

#include <Eigen/Core>

#include "model/control/linear_system.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// The stabilising solution X of A^T X A - X - A^T X B (R + B^T X B)^-1 B^T X A + Q = 0, and the
// gain K = (R + B^T X B)^-1 B^T X A of u = -K z that minimises the sum of z^T Q z + u^T R u under
// z+ = A z + B u. R is positive definite, Q positive semidefinite.
struct RiccatiSolution {
  Eigen::MatrixXd cost, gain;
};

// Throw InputError if there is no stabilising solution: something that no command moves, or that no
// weight sees, does not decay. Method: Chu, Fan, Lin and Wang, Int. J. Control 77 (2004).
[[nodiscard]] RiccatiSolution solve_discrete_riccati(const Eigen::MatrixXd& a,
                                                     const Eigen::MatrixXd& b,
                                                     const Eigen::MatrixXd& q,
                                                     const Eigen::MatrixXd& r);

// Does the same for z' = A z + B u and the integral: A^T X + X A - X B R^-1 B^T X + Q = 0,
// K = R^-1 B^T X. Method: a Cayley transform to the discrete one (Chu, Fan and Lin, Linear Algebra
// Appl. 396, 2005).
[[nodiscard]] RiccatiSolution solve_continuous_riccati(const Eigen::MatrixXd& a,
                                                       const Eigen::MatrixXd& b,
                                                       const Eigen::MatrixXd& q,
                                                       const Eigen::MatrixXd& r);

// The gain K of Law::lqr, u = K (reference - z) with z as plant_at_home() has it: rows phi, theta.
// Weights are the diagonals of Q and R. `period` (s) > 0 is that of a sampled loop, whose delays
// the gain does not know; 0 is continuous time. Throws InputError where no gain stabilizes.
[[nodiscard]] Eigen::Matrix<double, 2, 8> lqr_gain(const LinearPlant& plant,
                                                   const LqrWeights& weights, double period);

}  // namespace bbsim::model
