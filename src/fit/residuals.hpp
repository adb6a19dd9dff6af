// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Statistics of a fit's residuals by column.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// Residuals of all windows in SI units: model minus log.
[[nodiscard]] Eigen::VectorXd in_si(const WindowsFit& windows, const Eigen::VectorXd& residuals);

struct ColumnSize {
  double count = 0;
  double rms = 0;    // SI
  double usual = 0;  // SI; robust standard deviation: 1.4826 times the median size
};
[[nodiscard]] std::vector<ColumnSize> sizes_of(const WindowsFit& windows,
                                               const Eigen::VectorXd& residuals);

// Correlation of neighboring residuals within windows, by column.
[[nodiscard]] std::vector<double> correlations_of(const WindowsFit& windows,
                                                  const Eigen::VectorXd& residuals);

// Residuals of a column beyond five times its usual size. Gaussian noise has one in 1.7 million.
struct Outliers {
  std::size_t count = 0;
  std::size_t log = 0;  // of the first
  double time = 0;      // of the first, s
};
[[nodiscard]] std::vector<Outliers> outliers_of(const WindowsFit& windows,
                                                const Eigen::VectorXd& residuals,
                                                const std::vector<ColumnSize>& sizes);

// Huber's loss (Annals of Mathematical Statistics 35, 1964) is quadratic up to 1.345 standard
// deviations and linear beyond. It costs 5 % of the efficiency for Gaussian noise.
inline constexpr double huber_limit = 1.345;
// Square roots of its weights, min(1, limit / size), for residuals divided by the noise.
[[nodiscard]] Eigen::VectorXd huber_weights(const Eigen::VectorXd& over_noise);

}  // namespace bbsim::fit
