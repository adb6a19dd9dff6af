// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Levenberg and Marquardt's method on the windows of a fit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// Moves those numbers of `u` that are in `moving` to the least sum of squares near by. A key that
// comes to a bound stays there, and the others go on. Counts the iterations. False if the task is
// stopped: `u` is then the best so far.
bool minimize(const Task& task, WindowsFit& windows, std::vector<Eigen::Index> moving,
              Eigen::VectorXd& u, std::size_t& iterations);

// The same near an optimum, by Gauss and Newton's method with the derivatives that the windows have
// from there, which is ten times as cheap. Keys that are at a bound stay. False if that does not
// lead to a least sum of squares.
bool follow(const Task& task, WindowsFit& windows, Eigen::VectorXd& u);

// Whether the number is at a bound of the key's value.
[[nodiscard]] bool is_at_bound(const FreeKey& key, double u);

[[nodiscard]] bool is_stopped(const Task& task);

}  // namespace bbsim::fit
