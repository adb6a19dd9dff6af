// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sampled rigs in step, a case in each SIMD lane.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether most cases of the sweep are rigs that solve::sampled::RigLanes carries, as far as some
// from all over it tell, and all its measures are those of a track.
[[nodiscard]] bool can_use_rig_lanes(const SweepTask& task);

// Cases that go together.
[[nodiscard]] std::size_t rig_group();

// The task is one for which can_use_rig_lanes() holds, and outlives the runner. A case that does
// not fit among the others of its group, and one in which something happens, is run by itself.
[[nodiscard]] std::unique_ptr<CaseRunner> rig_lane_runner(const SweepTask& task);

}  // namespace bbsim::sweep
