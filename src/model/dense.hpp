// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The algebra of matrices that are small, and whose sizes only the scene tells. Eigen makes code of
// its own for every expression, of which compilers take seconds each: products of products,
// transposes and blocks all become one here. In this namespace a b of two matrices is that, too.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace bbsim::model {

// a b; the shapes have to fit.
[[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
[[nodiscard]] inline Eigen::MatrixXd operator*(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return product(a, b);
}

// The transposed matrix, as one and not as an expression.
[[nodiscard]] Eigen::MatrixXd transposed(const Eigen::MatrixXd& a);

// Of a square matrix; not finite if it is singular.
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

// x of a x = b, by elimination with pivots of rows; not finite if `a` is singular.
[[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// By pivots of rows and columns; nothing if `a` is singular, or anything not finite.
[[nodiscard]] std::optional<Eigen::MatrixXd> solve_if_regular(const Eigen::MatrixXd& a,
                                                              const Eigen::MatrixXd& b);

// e^a of a square matrix.
[[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& a);

}  // namespace bbsim::model
