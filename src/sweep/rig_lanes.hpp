// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of sampled rigs that advance in step, with a case in each SIMD lane.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether solve::sampled::RigLanes can run most of 16 cases from all over the sweep, and all
// measures are usual measures (lane_measures.hpp).
[[nodiscard]] bool can_use_rig_lanes(const SweepTask& task);

// The number of cases in a group.
[[nodiscard]] std::size_t rig_group();

// Requires can_use_rig_lanes(task). The task must outlive the runner. A case is run singly if it
// does not fit into its group or if an event happens in it.
[[nodiscard]] std::unique_ptr<CaseRunner> rig_lane_runner(const SweepTask& task);

}  // namespace bbsim::sweep
