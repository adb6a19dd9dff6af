// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is left to say of a case once its run has ended.
#pragma once

#include "sweep/task.hpp"

namespace bbsim::sweep {

// Measures that the case's scene does not have become no numbers; and a case that is done has a
// reason for each measure that is no finite number: that in `whys`, if any is known.
void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status,
           const scenario::Whys& whys = {});

// The same of a case that is done and whose scene has all measures, as most do: of most of them
// there is nothing to say. What `status` was before does not matter.
void judge_done(const SweepTask& task, const double* measures, CaseStatus& status);

}  // namespace bbsim::sweep
