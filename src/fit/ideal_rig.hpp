// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The simplest model of a rig, as a baseline for fitted ones.
#pragma once

#include <optional>

#include "scenario/scenario.hpp"

namespace bbsim::fit {

// The scene with a solid ball that rolls without losses on a perfectly mounted plate, which follows
// gimbal.motion or controller.commands without lag. Empty for scenes with feedback or torques.
[[nodiscard]] std::optional<Scenario> ideal_rig(const Scenario& scenario);

}  // namespace bbsim::fit
