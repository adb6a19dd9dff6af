// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The cycle after which the pattern of samples and camera frames repeats.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::model {

struct CommonCycle {
  double samples = 1, frames = 1;  // in a cycle: whole numbers
  // True without frames. False if frames and samples do not coincide again within 500 samples, or
  // if the samples' clock is uneven.
  bool known = true;
};

[[nodiscard]] CommonCycle common_cycle(const bbsim::Sampling& sampling, const Sensor& sensor);

// Instants of different clocks closer than this, relative to the sampling period, count as equal.
inline constexpr double one_instant = 1e-9;

}  // namespace bbsim::model
