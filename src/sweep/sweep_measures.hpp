// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the measures of a sweep by their names.
#pragma once

#include <string>
#include <vector>

#include "scenario/measures.hpp"
#include "sweep/plan.hpp"

namespace bbsim::sweep {

// The measures with these names. Throws InputError for a name given twice, and for a measure whose
// columns or window no case has. Tries the first case, then at most 4096 cases from all over the
// sweep.
[[nodiscard]] std::vector<scenario::Measure> sweep_measures(const std::vector<std::string>& names,
                                                            const ScenarioFamily& family,
                                                            const SweepPlan& plan);

}  // namespace bbsim::sweep
