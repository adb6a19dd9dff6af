// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/merit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace bbsim::design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Numbers u are of size 1: a standard deviation of 1e4 means that they are unknown.
constexpr double floor_of_information = 1e-8;
// Relative to the greatest eigenvalue, with the diagonal scaled to 1: the error of differences.
constexpr double rounding = 1e-8;

VectorXd sizes_of(const MatrixXd& information) {
  return information.diagonal().cwiseMax(1e-300).cwiseSqrt();
}

}  // namespace

double merit_of(const MatrixXd& information) {
  if (!information.allFinite()) return -std::numeric_limits<double>::max();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(information, Eigen::EigenvaluesOnly);
  double sum = 0;
  for (const double value : solver.eigenvalues()) {
    sum += std::log(std::max(value, 0.0) + floor_of_information);
  }
  return sum;
}

std::vector<double> deviations_of(const MatrixXd& information) {
  const Index keys = information.rows();
  std::vector<double> deviations(static_cast<std::size_t>(keys),
                                 std::numeric_limits<double>::infinity());
  if (!information.allFinite() || information.isZero(0)) return deviations;
  const VectorXd sizes = sizes_of(information);
  const MatrixXd scaled =
      sizes.cwiseInverse().asDiagonal() * information * sizes.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  const VectorXd& values = solver.eigenvalues();
  const double least = rounding * values.maxCoeff();
  for (Index k = 0; k < keys; ++k) {
    double variance = 0;
    bool told = true;
    for (Index j = 0; j < keys; ++j) {
      const double share = solver.eigenvectors()(k, j);
      if (values[j] > least) {
        variance += share * share / values[j];
      } else if (std::abs(share) > 0.02) {  // same threshold as in fits
        told = false;
      }
    }
    if (told) deviations[static_cast<std::size_t>(k)] = std::sqrt(variance) / sizes[k];
  }
  return deviations;
}

}  // namespace bbsim::design
