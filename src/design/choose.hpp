// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Chooses the most informative sums of sines.
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

// Draws sums of sines with frequencies around this one (rad/s), and improves the best ones. The
// same task gives the same result. Empty if no motion keeps the limits, or if interrupted.
[[nodiscard]] std::optional<Chosen> choose(const Task& task, const Experiment& experiment,
                                           double frequency);

}  // namespace bbsim::design
