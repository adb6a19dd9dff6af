// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Levenberg and Marquardt's method on the windows of a fit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// When the method ends: by the relative change of the sum of squares, by that of the numbers, and
// after so many evaluations.
struct Precision {
  double cost = 1e-12, numbers = 1e-9;
  int evaluations = 200;
};

// Moves those numbers of `u` that are in `moving` to the least sum of squares near by. A key that
// comes to a bound stays there, and the others go on. Counts the iterations. False if the task is
// stopped: `u` is then the best so far.
bool minimize(const Task& task, WindowsFit& windows, std::vector<Eigen::Index> moving,
              Eigen::VectorXd& u, std::size_t& iterations, const Precision& precision = {});

[[nodiscard]] bool is_stopped(const Task& task);

}  // namespace bbsim::fit
