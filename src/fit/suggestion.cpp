// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/suggestion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fit/scale_keys.hpp"
#include "model/dense.hpp"

namespace bbsim::fit {

using Eigen::Index;
using Eigen::VectorXd;

std::optional<Suggestion> suggestion(const Task& task, const WindowsFit& at, const VectorXd& u) {
  if (task.candidates.empty()) return {};
  Task wider = task;
  wider.keys.insert(wider.keys.end(), task.candidates.begin(), task.candidates.end());
  WindowsFit windows(wider, at.windows());
  windows.finish();
  windows.set_noise(at.noise());
  windows.set_weights(at.weights());
  windows.begin_as(at);
  VectorXd all = VectorXd::Zero(static_cast<Index>(wider.keys.size()));
  all.head(u.size()) = u;
  scale_keys(wider, windows, all);
  const VectorXd residuals = windows.residuals(all);
  const WindowsFit::Derivatives derivatives = windows.derivatives(all);
  const Eigen::MatrixXd& projected = derivatives.projected;

  // Remove what the keys themselves could still achieve: a candidate gets no credit for it.
  const model::LeastSquares keys(projected.leftCols(u.size()));
  const auto without_keys = [&](const VectorXd& column) -> VectorXd {
    return column - projected.leftCols(u.size()) * keys.solve(column);
  };
  const VectorXd left = without_keys(residuals);
  Suggestion best;
  for (Index k = u.size(); k < all.size(); ++k) {
    constexpr double least_part = 1e-3;
    const VectorXd column = without_keys(projected.col(k));
    if (!(column.norm() > least_part * derivatives.free_norms[k]))
      continue;  // keys or starts have the same effect
    const double step = -column.dot(left) / column.squaredNorm();
    const FreeKey& key = wider.keys[static_cast<std::size_t>(k)];
    const double bound = step > 0 ? key.upper : key.lower;
    if (key.value(0) == bound) continue;
    const double less = step * step * column.squaredNorm() / left.squaredNorm();
    const double share = 1 - std::sqrt(std::max(1 - less, 0.0));
    // Of two with the same effect, the first wins.
    constexpr double more = 0.01;
    if (best.key.empty() || share > best.share + more) best = Suggestion{key.name, share};
  }
  constexpr double least_share = 0.05;
  if (best.share < least_share) return {};
  return best;
}

}  // namespace bbsim::fit
