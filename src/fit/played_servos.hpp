// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Servos that follow commands which are known beforehand: where they are when a window begins.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::fit {

// The window of `whole` from `begin` to `end` (s) as a scene of its own. Where commands are played,
// its gimbal begins where the servos are by then: they have followed the commands of the second
// before, and before that they held the first of them. At 0 they are at gimbal.start, as in a run.
[[nodiscard]] Scenario window_of(const Scenario& whole, double begin, double end);

}  // namespace bbsim::fit
