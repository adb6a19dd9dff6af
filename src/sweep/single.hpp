// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs cases one by one, each with the integrator of `bbsim run`.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Gives the numbers of `bbsim run`, bit for bit. The task must outlive the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> single_runner(const SweepTask& task);

}  // namespace bbsim::sweep
