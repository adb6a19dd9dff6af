// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sums of sines that tell most.
#pragma once

#include <cstddef>
#include <optional>

#include "design/experiment.hpp"

namespace bbsim::design {

struct Chosen {
  Motion motion;
  double merit = 0;
  std::size_t tried = 0;
};

// Draws sums of sines of frequencies about this one (rad/s), and improves the best ones. The same
// task gives the same result. Nothing if no motion keeps the limits, or if it is interrupted.
[[nodiscard]] std::optional<Chosen> choose(const Task& task, const Experiment& experiment,
                                           double frequency);

}  // namespace bbsim::design
