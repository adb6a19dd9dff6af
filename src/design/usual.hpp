// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motions that one would play without a design.
#pragma once

#include <optional>

#include "design/experiment.hpp"

namespace bbsim::design {

// A circle of the ball (in a groove, a sine), of the multiple of 1/length that tells most; on a
// rig without a controller, with the ball launched onto it.
struct Circle {
  Motion motion;
  double frequency = 0;  // rad/s
};
[[nodiscard]] std::optional<Circle> best_circle(const Task& task, const Experiment& experiment);

// A step of both axes at a tenth of the time.
[[nodiscard]] std::optional<Motion> largest_step(const Task& task, const Experiment& experiment);

}  // namespace bbsim::design
