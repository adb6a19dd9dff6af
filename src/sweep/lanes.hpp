// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of given motions and of continuous control loops, with a case in each SIMD lane.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether open lanes (given motions, equation (27)) or lanes (loops, (31)) can run all cases, and
// all measures are usual measures (lane_measures.hpp).
[[nodiscard]] bool can_use_open_lanes(const SweepTask& task);
[[nodiscard]] bool can_use_lanes(const SweepTask& task);

// The number of cases in a group.
[[nodiscard]] std::size_t lane_group();

// Requires can_use_lanes(task) or can_use_open_lanes(task). The task must outlive the runner. Cases
// that the lanes give up are run singly. So are cases that grow without bound, if their motion is
// given or the sweep has a measure at the end other than x and y.
[[nodiscard]] std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task);

}  // namespace bbsim::sweep
