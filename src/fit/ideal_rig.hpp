// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The simplest model of a rig, which a fitted one has to be better than.
#pragma once

#include <optional>

#include "scenario/scenario.hpp"

namespace bbsim::fit {

// The scene with a solid ball that rolls without losses on a plate that is at once where
// gimbal.motion or controller.commands want it, without errors of its mounting. Nothing for scenes
// with feedback or torques.
[[nodiscard]] std::optional<Scenario> ideal_rig(const Scenario& scenario);

}  // namespace bbsim::fit
