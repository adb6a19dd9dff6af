// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Algebra of small matrices whose sizes depend on the scene. Eigen instantiates code for every
// expression, which costs compilers seconds each, so all operands here are plain matrices. In this
// namespace a b of two matrices calls product().
#pragma once

#include <Eigen/Core>
#include <optional>

namespace bbsim::model {

// Returns a b; the shapes must match.
[[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
[[nodiscard]] inline Eigen::MatrixXd operator*(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return product(a, b);
}

// Returns the transpose as a matrix, not an expression.
[[nodiscard]] Eigen::MatrixXd transposed(const Eigen::MatrixXd& a);

// Inverse of a square matrix; not finite if it is singular.
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

// Solves a x = b by elimination with row pivoting; not finite if `a` is singular.
[[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// The same with full pivoting; empty if `a` is singular or a number is not finite.
[[nodiscard]] std::optional<Eigen::MatrixXd> solve_if_regular(const Eigen::MatrixXd& a,
                                                              const Eigen::MatrixXd& b);

// e^a of a square matrix.
[[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& a);

}  // namespace bbsim::model
