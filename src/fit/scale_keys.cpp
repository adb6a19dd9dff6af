// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/scale_keys.hpp"

#include <cmath>
#include <cstddef>

namespace bbsim::fit {

Eigen::VectorXd scale_keys(Task& task, WindowsFit& windows, const Eigen::VectorXd& u) {
  constexpr int most_rounds = 8;
  constexpr double much = 10;
  const double root = std::sqrt(static_cast<double>(windows.size()));
  Eigen::VectorXd changes;
  for (int round = 0; round < most_rounds; ++round) {
    changes = windows.derivatives(u).free_norms / root;
    bool are_scaled = true;
    for (Eigen::Index k = 0; k < changes.size(); ++k) {
      FreeKey& key = task.keys[static_cast<std::size_t>(k)];
      // Only at u = 0 does another scale leave the key's value unchanged.
      if (key.logarithmic || u[k] != 0 || !(changes[k] > much)) continue;
      key.scale /= changes[k];
      are_scaled = false;
    }
    if (are_scaled) break;
  }
  return changes;
}

}  // namespace bbsim::fit
