// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/maxima.hpp"

#include <numbers>

namespace bbsim {
namespace {

// Chebyshev point `number` of `intervals` + 1 points on [0, 1].
double point(std::size_t number, std::size_t intervals) {
  const double part = static_cast<double>(number) / static_cast<double>(intervals);
  const double half_sine = std::sin(std::numbers::pi / 2 * part);
  return half_sine * half_sine;
}

}  // namespace

ChebyshevPoints::ChebyshevPoints(std::size_t intervals) : between_(intervals * (intervals + 1)) {
  const std::size_t last = intervals;
  for (std::size_t i = 0; i <= last; ++i) {
    points_.push_back(point(i, intervals));
    const double size = i == 0 || i == last ? 0.5 : 1.0;
    weights_.push_back(i % 2 == 0 ? size : -size);
  }
  start_slope_.push_back(0);
  for (std::size_t i = 1; i <= last; ++i) {
    start_slope_.push_back(-weights_[i] / weights_[0] / points_[i]);
  }
  for (std::size_t k = 0; k < intervals; ++k) {
    const double middle = point(2 * k + 1, 2 * intervals);
    double sum = 0;
    for (std::size_t i = 0; i <= last; ++i) sum += weights_[i] / (middle - points_[i]);
    for (std::size_t i = 0; i <= last; ++i) {
      between_[k * points_.size() + i] = weights_[i] / (middle - points_[i]) / sum;
    }
  }
}

// Four independent sums keep the processor's pipeline full.
double ChebyshevPoints::between(const double* values, std::size_t i) const {
  const std::size_t count = points_.size();
  const double* const share = &between_[i * count];
  double sums[4] = {0, 0, 0, 0};
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    for (std::size_t j = 0; j < 4; ++j) sums[j] += share[k + j] * values[k + j];
  }
  for (; k < count; ++k) sums[0] += share[k] * values[k];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

double ChebyshevPoints::at(const double* values, double s) const {
  double above = 0, below = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double distance = s - points_[i];
    if (distance == 0) return values[i];
    const double weight = weights_[i] / distance;
    above += weight * values[i];
    below += weight;
  }
  return above / below;
}

double ChebyshevPoints::slope_at_start(const double* values) const {
  double slope = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    slope += start_slope_[i] * (values[i] - values[0]);
  }
  return slope;
}

// The points are symmetric, so the weights for the start serve here in reverse.
double ChebyshevPoints::slope_at_end(const double* values) const {
  const std::size_t last = points_.size() - 1;
  double slope = 0;
  for (std::size_t i = 1; i <= last; ++i) {
    slope -= start_slope_[i] * (values[last - i] - values[last]);
  }
  return slope;
}

// Uses differences from each point's own value, so that the slope of a constant is exactly 0.
void ChebyshevPoints::slopes(const double* values, double* into) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    double slope = 0;
    for (std::size_t j = 0; j < points_.size(); ++j) {
      if (j == i) continue;
      slope += weights_[j] / weights_[i] / (points_[i] - points_[j]) * (values[j] - values[i]);
    }
    into[i] = slope;
  }
}

double ChebyshevPoints::overshoot() const {
  return std::log(static_cast<double>(size())) / std::numbers::pi;
}

// Uses T_N = +-1 at the points, and T_(N-1) = T_N cos(angle) with cos(angle) = 1 - 2 s.
double ChebyshevPoints::tail(const double* values) const {
  double last = 0, before = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    last += weights_[i] * values[i];
    before += weights_[i] * values[i] * (1 - 2 * points_[i]);
  }
  return (std::abs(last) + 2 * std::abs(before)) / static_cast<double>(points_.size() - 1);
}

const ChebyshevPoints& ChebyshevTables::points(std::size_t intervals) {
  if (of_.size() <= intervals) of_.resize(intervals + 1);
  auto& found = of_[intervals];
  if (found.empty()) found.emplace_back(intervals);
  return found.front();
}

}  // namespace bbsim
