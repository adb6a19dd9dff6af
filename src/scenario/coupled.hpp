// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tells which scenes need more than ideal rolling on a gimbal with prescribed motion.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

// Whether torques move the gimbal.
[[nodiscard]] bool moved_by_torques(const Scenario& scene);

// Whether rolling resistance or pivoting friction acts on the ball.
[[nodiscard]] bool has_dry_losses(const Scenario& scene);

// The key of dry friction in the scene, such as "ball.losses.rolling". Dry friction depends on the
// direction of motion and holds at rest. Null if there is none.
[[nodiscard]] const char* dry_part(const Scenario& scene);

// Whether a loss or a push acts on the ball, the ball may slide, or torques move the gimbal.
[[nodiscard]] bool is_coupled(const Scenario& scene);

// Whether push rods, measured curves or three servos connect the servos to the plane.
[[nodiscard]] bool is_linked(const Scenario& scene);

}  // namespace bbsim::scenario
