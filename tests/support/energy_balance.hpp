// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Total energy of all moving parts, plus losses and minus the motors' work: constant.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/ball/dynamics.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test {

// Largest deviation from the initial value over a run, relative to the largest part.
inline double energy_gap(const bbsim::Scenario& scene, const Run& run) {
  const bbsim::model::BallConstants constants = bbsim::model::constants_of(scene);
  double first = 0, gap = 0, size = 0;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    const bbsim::model::Dynamics now = bbsim::model::dynamics(run.samples[i], constants);
    const double whole = now.energy() + now.gimbal_energy;
    const double sum = whole + now.coupled.lost - now.coupled.work;
    if (i == 0) first = sum;
    gap = largest_finite(gap, {std::abs(sum - first)});
    size =
        std::max({size, std::abs(whole), std::abs(now.coupled.lost), std::abs(now.coupled.work)});
  }
  return gap / size;
}

}  // namespace bbsim_test
