// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Computes cases that share one prescribed motion of the gimbal as sums of a few solutions.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether every case of the sweep is a sum of the same solutions. Under a given motion, equation
// (27) is linear in (x, y, x', y', u), gravity and radius (docs/explanation/model.md, "Structure").
// Holds if only start, radius and gravity vary, and all measures are of position and tilt.
[[nodiscard]] bool can_superpose(const SweepTask& task);

// Computes the solutions once, for all runners. Null if double precision cannot follow the motion
// to the end.
struct Superposed;
[[nodiscard]] std::shared_ptr<const Superposed> solve_superposed(const SweepTask& task);

// Requires can_superpose(task). The task must outlive the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> superposition_runner(
    const SweepTask& task, std::shared_ptr<const Superposed> solutions);

}  // namespace bbsim::sweep
