// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/chain.hpp"

#include <cstddef>

#include "model/dense.hpp"

namespace bbsim::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// -(A^+ b); leaves a start unchanged if the residuals do not determine it.
MatrixXd best(const MatrixXd& a, const MatrixXd& b) {
  if (a.cols() == 0) return MatrixXd::Zero(0, b.cols());
  const VectorXd sizes = a.colwise().norm().cwiseMax(1e-300);
  const model::LeastSquares solver(a * sizes.cwiseInverse().asDiagonal(), 1e-9);
  return -(sizes.cwiseInverse().asDiagonal() * solver.solve(b));
}

}  // namespace

VectorXd Condensed::best_first() const {
  return best(by_first, residual);
}

MatrixXd Condensed::best_first_by_key() const {
  return best(by_first, by_key);
}

Condensed condense(const std::vector<const Link*>& links, const MatrixXd& first, Index keys) {
  Index rows = 0;
  for (const Link* const link : links) rows += link->residual.size();
  Condensed made;
  made.residual.resize(rows);
  made.by_first.resize(rows, first.cols());
  made.by_key.resize(rows, keys);
  Condensed::Shift shift{VectorXd::Zero(first.rows()), first, MatrixXd::Zero(first.rows(), keys)};
  Index row = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = *links[i];
    const Index size = link.residual.size();
    made.residual.segment(row, size) = link.residual + link.by_start * shift.closing;
    made.by_first.middleRows(row, size) = link.by_start * shift.by_first;
    if (keys > 0) {
      made.by_key.middleRows(row, size) = link.by_key + link.by_start * shift.by_key;
    }
    row += size;
    made.shifts.push_back(shift);
    if (i + 1 == links.size()) break;
    shift.closing = link.gap + link.end_by_start * shift.closing;
    shift.by_first = link.end_by_start * shift.by_first;
    if (keys > 0) shift.by_key = link.end_by_key + link.end_by_start * shift.by_key;
  }
  return made;
}

}  // namespace bbsim::fit
