// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/stage_equations.hpp"

#include <cstddef>

#include "model/dense.hpp"

namespace bbsim::study {
namespace {

using Block = std::vector<Eigen::Index>;

// Splits the numbers into blocks of mutual dependence, each block after those that it depends on.
std::vector<Block> blocks_of(const std::vector<Eigen::MatrixXd>& jacobians) {
  const Eigen::Index n = jacobians.front().rows();
  // depends(i, k): i depends on k, directly or through others (Warshall's algorithm).
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> depends(n, n);
  depends.setConstant(false);
  for (const Eigen::MatrixXd& jacobian : jacobians) depends = depends || jacobian.array() != 0;
  depends.matrix().diagonal().setConstant(true);
  for (Eigen::Index via = 0; via < n; ++via) {
    for (Eigen::Index i = 0; i < n; ++i) {
      if (depends(i, via)) depends.row(i) = depends.row(i) || depends.row(via);
    }
  }
  // A number with fewer dependencies comes first, because dependence is transitive.
  std::vector<Block> blocks;
  std::vector<char> taken(static_cast<std::size_t>(n), 0);
  for (Eigen::Index count = 1; count <= n; ++count) {
    for (Eigen::Index i = 0; i < n; ++i) {
      if (taken[static_cast<std::size_t>(i)] != 0 || depends.row(i).count() != count) continue;
      Block& block = blocks.emplace_back();
      for (Eigen::Index k = 0; k < n; ++k) {
        if (!depends(i, k) || !depends(k, i)) continue;
        block.push_back(k);
        taken[static_cast<std::size_t>(k)] = 1;
      }
    }
  }
  return blocks;
}

}  // namespace

void solve_stages(const std::vector<Eigen::MatrixXd>& jacobians, const Eigen::MatrixXd& matrix,
                  double h, const Eigen::MatrixXd& start, Eigen::MatrixXd& stages) {
  const auto s = static_cast<Eigen::Index>(jacobians.size());
  const Eigen::Index n = start.rows(), columns = start.cols();
  std::vector<char> solved(static_cast<std::size_t>(n), 0);
  Eigen::MatrixXd left, right, forced(s, columns);
  for (const Block& block : blocks_of(jacobians)) {
    const auto size = static_cast<Eigen::Index>(block.size());
    left.setIdentity(size * s, size * s);
    right.resize(size * s, columns);
    for (Eigen::Index a = 0; a < size; ++a) {
      const Eigen::Index number = block[static_cast<std::size_t>(a)];
      for (Eigen::Index j = 0; j < s; ++j) {
        const Eigen::MatrixXd& jacobian = jacobians[static_cast<std::size_t>(j)];
        forced.row(j) = stages.row(j * n + number);
        for (Eigen::Index k = 0; k < n; ++k) {
          if (solved[static_cast<std::size_t>(k)] != 0 && jacobian(number, k) != 0) {
            forced.row(j) += jacobian(number, k) * stages.row(j * n + k);
          }
        }
        for (Eigen::Index b = 0; b < size; ++b) {
          const double entry = jacobian(number, block[static_cast<std::size_t>(b)]);
          left.col(b * s + j).segment(a * s, s) -= h * entry * matrix.col(j);
        }
      }
      right.middleRows(a * s, s).noalias() = h * matrix * forced;
      right.middleRows(a * s, s).rowwise() += start.row(number);
    }
    const Eigen::MatrixXd found = model::solve(left, right);
    for (Eigen::Index a = 0; a < size; ++a) {
      const Eigen::Index number = block[static_cast<std::size_t>(a)];
      for (Eigen::Index j = 0; j < s; ++j) stages.row(j * n + number) = found.row(a * s + j);
      solved[static_cast<std::size_t>(number)] = 1;
    }
  }
}

}  // namespace bbsim::study
