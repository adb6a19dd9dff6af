// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs a scene over a window of a log.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fit/data.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::fit {

// The state at a window's start: x, y, vx, vy, phi, theta, phi_rate, theta_rate, spin (SI). The
// gimbal's angles are those of gimbal.start, and matter only where a controller or torques move it.
using Start = std::array<double, 9>;

// The scenario without what ends a run early or only watches it, at tolerances for differences.
[[nodiscard]] Scenario prepared(Scenario scenario);

// The columns at `times` (s, increasing, from 0 on), one column after the other. `scene` is
// from_time() of a prepared scenario. Empty, with the reason in `why`, if the run does not come to
// the last of them.
[[nodiscard]] std::vector<double> run_window(const Scenario& scene, const Start& start,
                                             const std::vector<double>& times,
                                             const std::vector<const scenario::Column*>& columns,
                                             std::string& why);

[[nodiscard]] Start start_of(const Scenario& scenario);

// Whether nothing but the loop says where the gimbal is when a window begins.
[[nodiscard]] bool begins_anywhere(const Scenario& scenario);

}  // namespace bbsim::fit
