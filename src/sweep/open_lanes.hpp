// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Balls under given motions in step, a case in each SIMD lane.
#pragma once

#include <optional>

#include "solve/open/open_lanes.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether the sweep is of scenes with a given motion under equation (27), whatever varies, and all
// its measures are those of a track.
[[nodiscard]] bool can_use_open_lanes(const SweepTask& task);

// How long steps are at first, measured on some cases from all over the sweep; nothing if lanes
// cannot carry these. The task is one for which can_use_open_lanes() holds.
[[nodiscard]] std::optional<solve::open::Pace> open_lane_pace(const SweepTask& task);

// Cases that step together.
[[nodiscard]] std::size_t open_lane_group();

// The task outlives the runner. A case that does not fit among the others of its group is run by
// itself.
[[nodiscard]] std::unique_ptr<CaseRunner> open_lane_runner(const SweepTask& task,
                                                           const solve::open::Pace& pace);

}  // namespace bbsim::sweep
