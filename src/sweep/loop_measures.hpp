// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Takes measures of the loop beside those of the motion, or alone, without running a case.
#pragma once

#include <memory>

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Whether nothing of the motion is asked for.
[[nodiscard]] bool is_of_loop_only(const SweepTask& task);

// The same task without its measures of the loop.
[[nodiscard]] SweepTask task_of_motion(const SweepTask& task);

// `motion` runs the cases of task_of_motion(), or is null if nothing is asked of the motion: the
// end time is then NaN. The tasks must outlive the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> loop_runner(const SweepTask& task,
                                                      std::unique_ptr<CaseRunner> motion);

}  // namespace bbsim::sweep
