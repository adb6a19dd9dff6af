// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs a scene over a window of a log.
#pragma once

#include <string>
#include <vector>

#include "fit/data.hpp"
#include "scenario/scenario.hpp"
#include "sweep/window.hpp"

namespace bbsim::fit {

using sweep::Start, sweep::start_of, sweep::begins_anywhere;

// The scenario without events that end a run early or only observe it, with tight tolerances.
[[nodiscard]] Scenario prepared(Scenario scenario);

// The columns at `times` (s, increasing, from 0), one column after the other. `scene` is
// from_time() of a prepared scenario. Empty, with the reason in `why`, if the run does not reach
// the last time.
[[nodiscard]] std::vector<double> run_window(const Scenario& scene, const Start& start,
                                             const std::vector<double>& times,
                                             const std::vector<const scenario::Column*>& columns,
                                             std::string& why);

}  // namespace bbsim::fit
