// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/common_cycle.hpp"

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

}  // namespace bbsim::model
