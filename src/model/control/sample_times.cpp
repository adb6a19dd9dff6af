// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/sample_times.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::model {

CommonCycle common_cycle(const bbsim::Sampling& sampling, const Sensor& sensor) {
  if (!sensor.period) return {};
  constexpr double most = 500;
  for (double samples = 1; samples <= most && sampling.is_even(); ++samples) {
    const double time = samples * sampling.period, frames = std::round(time / *sensor.period);
    if (frames < 1 || std::abs(time - frames * *sensor.period) > one_instant * sampling.period) {
      continue;
    }
    return {samples, frames, true};
  }
  return {1, 1, false};
}

namespace {

// Jitter has its own sequence for each seed, so that noise and dropouts draw as without it.
constexpr std::uint64_t other_sequence = 0x9e3779b97f4a7c15U;
// The shortest period, as a fraction of the nominal one.
constexpr double shortest = 0.1;

}  // namespace

SampleTimes::SampleTimes(const Sampling& sampling, std::uint64_t seed)
    : sampling_(sampling), noise_(seed + other_sequence) {}

double SampleTimes::at(double n) {
  if (sampling_.is_even()) return n * sampling_.period;
  while (first_ + static_cast<double>(times_.size()) <= n) {
    double period = sampling_.period;
    if (sampling_.periods.empty()) {
      period = std::max(shortest * period, period + sampling_.jitter * noise_.normal());
    } else {
      const double last = first_ + static_cast<double>(times_.size()) - 1;
      const auto count = static_cast<double>(sampling_.periods.size());
      period = sampling_.periods[static_cast<std::size_t>(std::fmod(last, count))];
    }
    times_.push_back(times_.back() + period);
  }
  return times_[static_cast<std::size_t>(n - first_)];
}

void SampleTimes::forget_before(double n) {
  for (; first_ < n && times_.size() > 1; ++first_) times_.pop_front();
}

}  // namespace bbsim::model
