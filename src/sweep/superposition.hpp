// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Cases that share one prescribed motion of the gimbal, as sums of a few solutions.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether every case of the sweep is a sum of the same solutions: equation (27) is linear in
// (x, y, x', y', u), gravity and radius under a given motion (docs/explanation/model.md,
// "Structure"). Holds if start, radius and gravity are all that varies, and the measures are of
// position and tilt.
[[nodiscard]] bool can_superpose(const SweepTask& task);

// The solutions, made once and shared by the runners. Null of a motion that double precision cannot
// follow to the end.
struct Superposed;
[[nodiscard]] std::shared_ptr<const Superposed> solve_superposed(const SweepTask& task);

// The task is one for which can_superpose() holds, and outlives the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> superposition_runner(
    const SweepTask& task, std::shared_ptr<const Superposed> solutions);

}  // namespace bbsim::sweep
