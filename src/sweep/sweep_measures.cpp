// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/sweep_measures.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace bbsim::sweep {
namespace {

constexpr std::size_t most_looked_at = 4096;

bool any_case_has(const scenario::Measure& measure, const ScenarioFamily& family,
                  const SweepPlan& plan) {
  // Numbers that no rule relates to another key change neither columns nor windows.
  if (plan.independent()) return false;
  const std::size_t cases = plan.cases(), looks = std::min(cases, most_looked_at);
  for (std::size_t i = 0; i < looks; ++i) {
    const std::size_t number = cases > looks ? plan.sampled(i) : i;
    try {
      if (!scenario::missing(measure, family.read(plan.settings(number)))) return true;
    } catch (const InputError&) {  // plan.check() reports it
      continue;
    }
  }
  return false;
}

}  // namespace

std::vector<scenario::Measure> sweep_measures(const std::vector<std::string>& names,
                                              const ScenarioFamily& family, const SweepPlan& plan) {
  const Scenario first = family.read(plan.first_settings());
  std::vector<scenario::Measure> measures;
  for (const std::string& name : names) {
    const auto measure = scenario::find_measure(name);
    const bool of_others =
        measure && scenario::missing(*measure, first) && any_case_has(*measure, family, plan);
    measures.push_back(of_others ? *measure : scenario::measure_named("measure", name, first));
  }
  scenario::require_once(measures);
  return measures;
}

}  // namespace bbsim::sweep
