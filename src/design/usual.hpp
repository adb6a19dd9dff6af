// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motions that a user would play without a design.
#pragma once

#include <optional>

#include "design/experiment.hpp"

namespace bbsim::design {

// A circle of the ball (in a groove, a sine) at the most informative multiple of 1/length. On a rig
// without a controller, the ball is launched onto it.
struct Circle {
  Motion motion;
  double frequency = 0;  // rad/s
};
[[nodiscard]] std::optional<Circle> best_circle(const Task& task, const Experiment& experiment);

// The largest step of both axes, at a tenth of the time.
[[nodiscard]] std::optional<Motion> largest_step(const Task& task, const Experiment& experiment);

}  // namespace bbsim::design
