// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of balls under prescribed motions, in lock step with a case in each SIMD lane.
#pragma once

#include <optional>

#include "solve/open/open_lanes.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether all cases have a prescribed motion under equation (27) that lanes can carry, and all
// measures are track measures (record/track/track_measures.hpp).
[[nodiscard]] bool can_use_open_lanes(const SweepTask& task);

// Measures the first step and the number of nodes on 32 cases from all over the sweep. Empty if
// lanes cannot carry these cases. Requires can_use_open_lanes(task).
[[nodiscard]] std::optional<solve::open::Pace> open_lane_pace(const SweepTask& task);

// The number of cases in a group.
[[nodiscard]] std::size_t open_lane_group();

// The task must outlive the runner. A case that does not fit into its group is run singly.
[[nodiscard]] std::unique_ptr<CaseRunner> open_lane_runner(const SweepTask& task,
                                                           const solve::open::Pace& pace);

}  // namespace bbsim::sweep
