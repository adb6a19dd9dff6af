// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Loops of one kind, a case in each SIMD lane.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether the sweep is of loops under equation (31) at tolerances where lanes are ahead of single
// runs, and all its measures are those of a track.
[[nodiscard]] bool can_use_lanes(const SweepTask& task);

// Cases that begin together.
[[nodiscard]] std::size_t lane_group();

// The task is one for which can_use_lanes() holds, and outlives the runner. A case that the
// lanes give up is run by itself, and so is one that grows without bound, if more than x and y are
// asked of its end.
[[nodiscard]] std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task);

}  // namespace bbsim::sweep
