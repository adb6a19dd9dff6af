// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Levenberg-Marquardt method on the windows of a fit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// Moves the entries `moving` of `u` to the nearby least sum of squares. A key that reaches a bound
// stays there while the others continue. Counts the iterations. Returns false if the task is
// stopped; `u` is then the best so far.
bool minimize(const Task& task, WindowsFit& windows, std::vector<Eigen::Index> moving,
              Eigen::VectorXd& u, std::size_t& iterations);

// Does the same near an optimum by the Gauss-Newton method with the windows' known derivatives,
// which is ten times cheaper. Keys at a bound stay there. Returns false if it does not reach the
// least sum of squares.
bool follow(const Task& task, WindowsFit& windows, Eigen::VectorXd& u);

// Whether u is at a bound of the key's value.
[[nodiscard]] bool is_at_bound(const FreeKey& key, double u);

[[nodiscard]] bool is_stopped(const Task& task);

}  // namespace bbsim::fit
