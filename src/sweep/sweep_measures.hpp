// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures of a sweep.
#pragma once

#include <string>
#include <vector>

#include "scenario/measures.hpp"
#include "sweep/plan.hpp"

namespace bbsim::sweep {

// The measures of these names, each given once, which a case of the sweep has the columns and the
// time for: the first one, or another; not all of many are looked at. Throws InputError.
[[nodiscard]] std::vector<scenario::Measure> sweep_measures(const std::vector<std::string>& names,
                                                            const ScenarioFamily& family,
                                                            const SweepPlan& plan);

}  // namespace bbsim::sweep
