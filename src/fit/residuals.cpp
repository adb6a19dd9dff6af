// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/residuals.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::fit {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd in_si(const WindowsFit& windows, const VectorXd& residuals) {
  VectorXd raw = residuals.cwiseQuotient(windows.weights());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    raw[static_cast<Index>(i)] *= windows.noise()[windows.columns_of_rows()[i]];
  }
  return raw;
}

std::vector<ColumnSize> sizes_of(const WindowsFit& windows, const VectorXd& residuals) {
  const VectorXd raw = in_si(windows, residuals);
  std::vector<ColumnSize> made(windows.noise().size());
  std::vector<std::vector<double>> sizes(made.size());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    sizes[windows.columns_of_rows()[i]].push_back(std::abs(raw[static_cast<Index>(i)]));
  }
  for (std::size_t c = 0; c < made.size(); ++c) {
    if (sizes[c].empty()) continue;
    made[c].count = static_cast<double>(sizes[c].size());
    double squares = 0;
    for (const double size : sizes[c]) squares += size * size;
    made[c].rms = std::sqrt(squares / made[c].count);
    const auto middle = sizes[c].begin() + static_cast<std::ptrdiff_t>(sizes[c].size() / 2);
    std::ranges::nth_element(sizes[c], middle);
    made[c].usual = 1.4826 * *middle;
  }
  return made;
}

std::vector<double> correlations_of(const WindowsFit& windows, const VectorXd& residuals) {
  const std::size_t columns = windows.noise().size();
  std::vector<double> products(columns, 0), squares(columns, 0);
  const auto at = [&](std::size_t i) { return residuals[static_cast<Index>(i)]; };
  for (std::size_t w = 0; w < windows.windows().size(); ++w) {
    for (std::size_t i = windows.first_row(w); i < windows.first_row(w + 1); ++i) {
      const std::size_t c = windows.columns_of_rows()[i];
      squares[c] += at(i) * at(i);
      const bool has_next =
          i + 1 < windows.first_row(w + 1) && windows.columns_of_rows()[i + 1] == c;
      if (has_next) products[c] += at(i) * at(i + 1);
    }
  }
  for (std::size_t c = 0; c < columns; ++c) products[c] /= std::max(squares[c], 1e-300);
  return products;
}

std::vector<Outliers> outliers_of(const WindowsFit& windows, const VectorXd& residuals,
                                  const std::vector<ColumnSize>& sizes) {
  const VectorXd raw = in_si(windows, residuals);
  std::vector<Outliers> made(sizes.size());
  for (std::size_t w = 0; w < windows.windows().size(); ++w) {
    const Window& window = windows.windows()[w];
    std::size_t row = windows.first_row(w);
    for (std::size_t c = 0; c < window.values.size(); ++c) {
      for (std::size_t i = 0; i < window.times.size(); ++i) {
        if (!std::isfinite(window.values[c][i])) continue;
        if (!(std::abs(raw[static_cast<Index>(row++)]) > 5 * sizes[c].usual)) continue;
        if (made[c].count++ == 0) {
          made[c].log = window.log;
          made[c].time = window.begin + window.times[i];
        }
      }
    }
  }
  return made;
}

VectorXd huber_weights(const VectorXd& over_noise) {
  return over_noise.unaryExpr([](double residual) {
    return std::sqrt(std::min(1.0, huber_limit / std::max(std::abs(residual), 1e-300)));
  });
}

}  // namespace bbsim::fit
