// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What an experiment is worth, and the standard deviations that it leaves.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bbsim::design {

// The logarithm of the determinant, with a floor for directions of keys that the log does not
// tell: a design that tells all is better than any that does not.
[[nodiscard]] double merit_of(const Eigen::MatrixXd& information);

// Of each number: infinite where the log does not tell it.
[[nodiscard]] std::vector<double> deviations_of(const Eigen::MatrixXd& information);

}  // namespace bbsim::design
