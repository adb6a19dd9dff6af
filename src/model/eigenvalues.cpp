// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace bbsim::model {

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return {};
  // Eigen's solver does not balance: rounding of a stiff servo's entries would reach all others.
  const Eigen::MatrixXd even = balanced(matrix);
  const double unit = unit_of(even);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(even / unit, false);
  if (solver.info() != Eigen::Success) return {};
  return in_units({solver.eigenvalues().begin(), solver.eigenvalues().end()}, unit);
}

double unit_of(const Eigen::MatrixXd& matrix) {
  const double largest = matrix.size() == 0 ? 0 : matrix.cwiseAbs().maxCoeff();
  return largest > 0 ? std::exp2(std::ilogb(largest)) : 1;
}

std::vector<std::complex<double>> in_units(std::vector<std::complex<double>> values, double unit) {
  for (auto& value : values) {
    value *= unit;
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) return {};
  }
  return values;
}

Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix, Eigen::VectorXd* scale) {
  Eigen::MatrixXd result = matrix;
  const Eigen::Index n = result.rows();
  if (scale != nullptr) scale->setOnes(n);
  constexpr int enough = 100;
  bool changes = true;
  for (int pass = 0; pass < enough && changes; ++pass) {
    changes = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      double row = 0, column = 0;
      for (Eigen::Index j = 0; j < n; ++j) {
        if (j == i) continue;
        row += std::abs(result(i, j));
        column += std::abs(result(j, i));
      }
      if (!(row > 0 && column > 0)) continue;
      const double factor = std::exp2(std::round((std::log2(row) - std::log2(column)) / 2));
      if (!(column * factor + row / factor < 0.95 * (row + column))) continue;
      changes = true;
      result.row(i) /= factor;
      result.col(i) *= factor;
      if (scale != nullptr) (*scale)[i] *= factor;
    }
  }
  return result;
}

}  // namespace bbsim::model
