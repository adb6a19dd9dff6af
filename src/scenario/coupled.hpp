// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which scenes have more than ideal rolling under a gimbal that moves whatever the torques.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

// Whether torques move the gimbal.
[[nodiscard]] bool moved_by_torques(const Scenario& scene);

// Whether rolling resistance or pivoting friction acts on the ball.
[[nodiscard]] bool has_dry_losses(const Scenario& scene);

// Whether any loss does, the ball may slide, or torques move the gimbal.
[[nodiscard]] bool is_coupled(const Scenario& scene);

// Whether push rods, measured curves or three servos stand between the servos and the plane.
[[nodiscard]] bool is_linked(const Scenario& scene);

}  // namespace bbsim::scenario
