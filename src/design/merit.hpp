// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The merit of an experiment, and the standard deviations that it leaves.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bbsim::design {

// The logarithm of the determinant. Its floor for directions of keys that the log does not
// determine ranks designs that determine all keys above all others.
[[nodiscard]] double merit_of(const Eigen::MatrixXd& information);

// The standard deviation of each number; infinite if the log does not determine it.
[[nodiscard]] std::vector<double> deviations_of(const Eigen::MatrixXd& information);

}  // namespace bbsim::design
