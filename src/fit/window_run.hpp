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

// State at a window's start: x, y, vx, vy, phi, theta, phi_rate, theta_rate, spin (SI). The angles
// are those of gimbal.start; they matter only if a controller or torques move the gimbal.
using Start = std::array<double, 9>;

// The scenario without events that end a run early or only observe it, with tight tolerances.
[[nodiscard]] Scenario prepared(Scenario scenario);

// The columns at `times` (s, increasing, from 0), one column after the other. `scene` is
// from_time() of a prepared scenario. Empty, with the reason in `why`, if the run does not reach
// the last time.
[[nodiscard]] std::vector<double> run_window(const Scenario& scene, const Start& start,
                                             const std::vector<double>& times,
                                             const std::vector<const scenario::Column*>& columns,
                                             std::string& why);

[[nodiscard]] Start start_of(const Scenario& scenario);

// Whether the gimbal's state at a window's start is free: no given motion or commands set it.
[[nodiscard]] bool begins_anywhere(const Scenario& scenario);

}  // namespace bbsim::fit
