// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The time after which samples and a camera's frames meet again as they did.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::model {

struct CommonCycle {
  double samples = 1, frames = 1;  // that it has: whole numbers
  // Without frames there is nothing to know. Of frames that never meet the samples again, or not
  // within 500 of them, or whose samples' clock is uneven, nothing is.
  bool known = true;
};

[[nodiscard]] CommonCycle common_cycle(const Sampling& sampling, const Sensor& sensor);

// Instants of different clocks that are nearer than this, relative to the period of the samples,
// are one.
inline constexpr double one_instant = 1e-9;

}  // namespace bbsim::model
