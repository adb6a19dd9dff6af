// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_scenario.hpp"

#include "scenario/independent.hpp"

namespace bbsim::sweep {

CaseScenario::CaseScenario(const SweepTask& task)
    : task_(task), scenario_(task.family.read(task.plan.settings(0))) {
  for (const PlanAxis& axis : task.plan.axes()) {
    in_place_ = in_place_ && axis.independent;
    if (in_place_) places_.push_back(independent_number(scenario_, axis.key));
  }
}

const Scenario& CaseScenario::at(std::size_t number, const double* values) {
  if (in_place_) {
    for (std::size_t a = 0; a < places_.size(); ++a) {
      for (double* const place : places_[a]) *place = values[a];
    }
  } else {
    scenario_ = task_.family.read(task_.plan.settings(number));
  }
  return scenario_;
}

}  // namespace bbsim::sweep
