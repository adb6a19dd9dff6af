// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A ball in a groove or between rails, which rolls along one axis.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

// Why the scene does not move along x (0) or y (1) alone; empty if it does.
[[nodiscard]] std::string why_not_along(int axis, const Scenario& scene);

// Sets the axis of a ball in a groove and the coordinate that its sensor measures. Call it after
// all sections are read.
void place_groove(Scenario& scene);

}  // namespace bbsim::scenario
