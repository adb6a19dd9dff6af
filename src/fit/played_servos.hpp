// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Servos that follow known commands: their state when a window starts.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::fit {

// The window of `whole` from `begin` to `end` (s) as a scene. With played commands, the gimbal
// starts where the servos are after following the commands of the second before, and holding the
// first of them until then. At 0 it starts at gimbal.start, as in a run.
[[nodiscard]] Scenario window_of(const Scenario& whole, double begin, double end);

}  // namespace bbsim::fit
