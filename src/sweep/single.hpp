// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Cases one by one, each by the integrator that a run of it takes.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// The same numbers as `bbsim run` gives, to the bit. The task outlives the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> single_runner(const SweepTask& task);

}  // namespace bbsim::sweep
