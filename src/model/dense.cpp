// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/dense.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

#include "base/real.hpp"

template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;

namespace bbsim::model {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd product(const MatrixXd& a, const MatrixXd& b) {
  return a.operator*(b);  // Eigen's operator
}

MatrixXd transposed(const MatrixXd& a) {
  return a.transpose();
}

MatrixXd inverse(const MatrixXd& a) {
  return a.inverse();
}

MatrixXd solve(const MatrixXd& a, const MatrixXd& b) {
  return Eigen::PartialPivLU<MatrixXd>(a).solve(b);
}

std::optional<MatrixXd> solve_if_regular(const MatrixXd& a, const MatrixXd& b) {
  if (!a.allFinite()) return {};
  const Eigen::FullPivLU<MatrixXd> factors(a);
  if (!factors.isInvertible()) return {};
  MatrixXd solution = factors.solve(b);
  if (!solution.allFinite()) return {};
  return solution;
}

Elimination::Elimination(const MatrixXd& a)
    : factors_(std::make_shared<Eigen::PartialPivLU<MatrixXd>>(a)) {}

VectorXd Elimination::solve(const VectorXd& b) const {
  return factors_->solve(b);
}

SingularValues singular_values(const MatrixXd& a) {
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

MatrixXd exponential(const MatrixXd& a) {
  const Eigen::Index n = a.rows();
  if (!a.allFinite()) {
    return MatrixXd::Constant(n, n, no_number);
  }
  const double size = n == 0 ? 0 : a.cwiseAbs().rowwise().sum().maxCoeff();
  int halvings = 0;
  while (std::ldexp(size, -halvings) > 0.5) ++halvings;
  const MatrixXd part = std::ldexp(1.0, -halvings) * a, identity = MatrixXd::Identity(n, n);
  // Leave out the identity until the end: rounding beside it would lose slow parts next to fast
  // ones. Take e^a - 1 of a small part by its series, then (e^2a - 1) = (e^a - 1)^2 + 2 (e^a - 1).
  constexpr int terms = 18;  // 0.5^18 / 18! is below rounding
  MatrixXd series = identity;
  for (int k = terms; k > 1; --k) series = identity + part * series / k;
  MatrixXd less_one = part * series;
  for (int i = 0; i < halvings; ++i) {
    const MatrixXd square = less_one * less_one;
    less_one = square + 2 * less_one;
  }
  return less_one + identity;
}

}  // namespace bbsim::model
