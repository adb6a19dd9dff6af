// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/multisine.hpp"

#include <algorithm>
#include <cmath>

#include "model/dense.hpp"

namespace bbsim::design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t components = 4;  // of an axis

// Draws different multiples whose logarithms are normally distributed.
std::vector<std::size_t> draw_multiples(const Multisine::Band& band, Noise& noise) {
  constexpr double spread = 0.8;
  std::vector<std::size_t> multiples;
  while (multiples.size() < components) {
    const double drawn = std::round(band.middle * std::exp(spread * noise.normal()));
    if (!(drawn >= 1) || !(drawn <= static_cast<double>(band.highest))) continue;
    const auto multiple = static_cast<std::size_t>(drawn);
    if (std::ranges::find(multiples, multiple) == multiples.end()) multiples.push_back(multiple);
  }
  std::ranges::sort(multiples);
  return multiples;
}

// Rows that map amplitudes of cosines and sines to the values that Multisine requires to be zero.
MatrixXd conditions(const std::vector<double>& frequencies, Plays plays) {
  const auto n = static_cast<Index>(frequencies.size());
  MatrixXd rows = MatrixXd::Zero(plays == Plays::tilts ? 3 : 2, 2 * n);
  const double scale = frequencies.front();
  for (Index i = 0; i < n; ++i) {
    const double w = frequencies[static_cast<std::size_t>(i)] / scale;
    rows(0, i) = 1;                                     // the value at the start
    rows(1, n + i) = w;                                 // the rate
    if (plays == Plays::tilts) rows(2, n + i) = 1 / w;  // the velocity that a tilt leaves
  }
  return rows;
}

}  // namespace

Multisine::Multisine(const Band& band, Noise& noise) : plays_(band.plays) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!band.axes[i]) continue;
    Axis& axis = axes_[i];
    for (const std::size_t multiple : draw_multiples(band, noise)) {
      axis.frequencies.push_back(turn * static_cast<double>(multiple) / band.length);
    }
    // Tilts proportional to w^2 move the ball equally at all frequencies.
    const double power =
        band.plays == Plays::tilts ? 2 * noise.uniform() - 0.5 : 1.5 * noise.uniform() - 2;
    const auto n = static_cast<Index>(components);
    Eigen::VectorXd weights(2 * n);
    for (Index k = 0; k < n; ++k) {
      const double w = axis.frequencies[static_cast<std::size_t>(k)] / axis.frequencies.front();
      weights[k] = weights[n + k] = std::pow(w, power);
    }
    const MatrixXd rows = conditions(axis.frequencies, band.plays) * weights.asDiagonal();
    const MatrixXd v = model::singular_values(rows, Eigen::ComputeFullV).v;
    axis.amplitudes = weights.asDiagonal() * v.rightCols(2 * n - rows.rows());
  }
}

std::size_t Multisine::size() const {
  return static_cast<std::size_t>(axes_[0].amplitudes.cols() + axes_[1].amplitudes.cols());
}

Motion Multisine::motion(const std::vector<double>& numbers) const {
  Motion made;
  made.centered = plays_ == Plays::tilts;
  Index used = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Axis& axis = axes_[i];
    const Index own = axis.amplitudes.cols();
    if (own == 0) continue;
    const Eigen::VectorXd amplitudes =
        axis.amplitudes * Eigen::Map<const Eigen::VectorXd>(numbers.data() + used, own);
    used += own;
    const auto n = static_cast<Index>(axis.frequencies.size());
    for (Index k = 0; k < n; ++k) {
      const double cosine = amplitudes[k], sine = amplitudes[n + k];
      made.sines[i].push_back({std::hypot(cosine, sine),
                               axis.frequencies[static_cast<std::size_t>(k)],
                               std::atan2(cosine, sine)});
    }
  }
  return made;
}

std::size_t highest_multiple(double length, double rate) {
  // Faster tilts move a ball by less than its sensor resolves.
  constexpr double most = 3, samples_per_period = 8;
  const double highest = std::floor(std::min(most, rate / samples_per_period) * length);
  return std::max(components, static_cast<std::size_t>(highest));
}

}  // namespace bbsim::design
