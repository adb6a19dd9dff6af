// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/identified_law.hpp"

#include <algorithm>

#include "model/dense.hpp"

namespace bbsim::model {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Hankel matrix of the response: block (i, j) is that of sample first + i + j.
MatrixXd hankel(const PulseResponse& response, Index first, Index blocks) {
  const Index rows = response.front().rows(), columns = response.front().cols();
  MatrixXd of(rows * blocks, columns * blocks);
  for (Index i = 0; i < blocks; ++i) {
    for (Index j = 0; j < blocks; ++j) {
      of.block(i * rows, j * columns, rows, columns) =
          response[static_cast<std::size_t>(first + i + j)];
    }
  }
  return of;
}

double largest_number(const PulseResponse& response) {
  double largest = 0;
  for (const MatrixXd& block : response) largest = std::max(largest, block.cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace

std::optional<LinearSystem> law_of(const PulseResponse& response, double noise) {
  const Index blocks = (static_cast<Index>(response.size()) - 1) / 2;
  const MatrixXd now = hankel(response, 1, blocks), next = hankel(response, 2, blocks);
  const SingularValues svd = singular_values(now);
  const Eigen::VectorXd& sizes = svd.values;
  // Noise alone gives singular values up to its size times the larger dimension.
  const double least =
      std::max(1e-11 * sizes[0], noise * static_cast<double>(std::max(now.rows(), now.cols())));
  Index states = 0;
  while (states < sizes.size() && sizes[states] > least) ++states;
  const Eigen::VectorXd root = sizes.head(states).cwiseSqrt();
  MatrixXd left = svd.u.leftCols(states), right = svd.v.leftCols(states);
  LinearSystem law;
  law.d = response.front();
  law.c = left.topRows(law.d.rows());
  law.b = transposed(right.topRows(law.d.cols()));
  for (Index i = 0; i < states; ++i) {
    law.c.col(i) *= root[i];
    law.b.row(i) *= root[i];
    left.col(i) /= root[i];
    right.col(i) /= root[i];
  }
  law.a = product(transposed(left), product(next, right));

  const double near = 0.02 * largest_number(response);
  MatrixXd state = law.b;
  for (std::size_t k = 1; k < response.size(); ++k) {
    const MatrixXd off = product(law.c, state) - response[k];
    if (!(off.cwiseAbs().maxCoeff() <= near)) return {};
    state = product(law.a, state);
  }
  return law;
}

}  // namespace bbsim::model
