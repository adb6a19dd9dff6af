// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Algebra of small matrices whose sizes depend on the scene. Eigen instantiates code for every
// expression, and more for every decomposition, which costs compilers seconds each. So all operands
// here are plain matrices, and decompositions are compiled here only. In this namespace a b of two
// matrices calls product().
#pragma once

#include <Eigen/Core>
#include <memory>
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

// Factors of a square matrix by elimination with row pivoting, to solve a x = b for several b.
class Elimination {
 public:
  Elimination() = default;
  explicit Elimination(const Eigen::MatrixXd& a);
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  std::shared_ptr<const Eigen::PartialPivLU<Eigen::MatrixXd>> factors_;
};

// a = u diag(values) v^T, with the values in descending order, and as many columns in u and v.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd u, v;
};
[[nodiscard]] SingularValues singular_values(const Eigen::MatrixXd& a);

// e^a of a square matrix.
[[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& a);

}  // namespace bbsim::model
