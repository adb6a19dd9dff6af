// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What runs the cases of a sweep. A task must outlive its runner.
#pragma once

#include <memory>

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Single runs: cases one by one, with the numbers of `bbsim run`, bit for bit.
[[nodiscard]] std::unique_ptr<CaseRunner> single_runner(const SweepTask& task);

// Whether open lanes (given motions, equation (27)) or lanes (loops, (31)) can run all cases, and
// all measures are usual measures (lanes.cpp).
[[nodiscard]] bool can_use_open_lanes(const SweepTask& task);
[[nodiscard]] bool can_use_lanes(const SweepTask& task);
// Requires one of these. Cases that the lanes give up are run singly. So are cases that grow
// without bound, if their motion is given or the sweep has a measure at the end other than x and y.
[[nodiscard]] std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task);
// The number of cases in a group.
[[nodiscard]] std::size_t lane_group();

// Whether solve::sampled::RigLanes can run most of 16 cases from all over the sweep, with all
// measures and series.
[[nodiscard]] bool can_use_rig_lanes(const SweepTask& task);
// Requires this. A case is run singly if it does not fit into its group or if an event happens in
// it.
[[nodiscard]] std::unique_ptr<CaseRunner> rig_lane_runner(const SweepTask& task);
[[nodiscard]] std::size_t rig_group();

// Whether the task asks only for measures of the loop, which need no run; and the same task without
// them.
[[nodiscard]] bool is_of_loop_only(const SweepTask& task);
[[nodiscard]] SweepTask task_of_motion(const SweepTask& task);
// `motion` runs the cases of task_of_motion(). It is null if the task asks only for measures of the
// loop; the end time is then NaN.
[[nodiscard]] std::unique_ptr<CaseRunner> loop_runner(const SweepTask& task,
                                                      std::unique_ptr<CaseRunner> motion);

}  // namespace bbsim::sweep
