// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Computes measures of the loop, which need no run, alone or beside measures of the motion.
#pragma once

#include <memory>

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether the task asks only for measures of the loop.
[[nodiscard]] bool is_of_loop_only(const SweepTask& task);

// The same task without its measures of the loop.
[[nodiscard]] SweepTask task_of_motion(const SweepTask& task);

// `motion` runs the cases of task_of_motion(). It is null if the task asks only for measures of the
// loop; the end time is then NaN. The tasks must outlive the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> loop_runner(const SweepTask& task,
                                                      std::unique_ptr<CaseRunner> motion);

}  // namespace bbsim::sweep
