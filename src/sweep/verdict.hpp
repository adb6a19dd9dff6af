// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Completes the status of a case once its run has ended.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Sets measures that the case's scene lacks to NaN. In a case that is done, gives the reason for
// each measure that is not finite: the reason in `whys`, if there is one.
void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status,
           const scenario::Whys& whys = {});

// Does the same for a case that is done and whose scene has all measures; most of these need no
// reason. The previous content of `status` does not matter.
void judge_done(const SweepTask& task, const double* measures, CaseStatus& status);

}  // namespace bbsim::sweep
