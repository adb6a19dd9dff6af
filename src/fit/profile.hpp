// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Intervals by profile likelihood: how far a key can go before the best sum of squares, with all
// other keys free, has grown by what the confidence allows.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

struct Ends {
  double low, high;  // of the key's number; infinite where no value is refuted
};

// Of key `k` at the optimum `u`, whose linearized covariance is `covariance`. `growth` is the sum
// of squares that an end has more than the optimum has, `moving` has the keys that are not at a
// bound.
[[nodiscard]] Ends profile(const Task& task, WindowsFit& windows, const Eigen::VectorXd& u,
                           const Eigen::MatrixXd& covariance, Eigen::Index k, double growth,
                           const std::vector<Eigen::Index>& moving, std::size_t& iterations);

}  // namespace bbsim::fit
