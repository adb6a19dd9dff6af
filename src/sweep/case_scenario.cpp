// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_scenario.hpp"

#include <algorithm>

#include "scenario/independent.hpp"
#include "sweep/window.hpp"

namespace bbsim::sweep {

CaseScenario::CaseScenario(const SweepTask& task)
    : task_(task), scenario_(task.family.read(task.plan.first_settings())) {
  for (const PlanAxis& axis : task.plan.axes()) {
    in_place_ = in_place_ && axis.independent;
    if (in_place_) places_.push_back(independent_number(scenario_, axis.key));
  }
  if (task.windows != nullptr && !task.windows->events) remove_events(scenario_);
}

bool CaseScenario::put(std::size_t number, const double* values) {
  if (in_place_) {
    for (std::size_t a = 0; a < places_.size(); ++a) {
      for (double* const place : places_[a]) *place = values[a];
    }
    return !places_.empty();
  }
  // Windows often come in groups that share their values, and each reading takes time.
  const std::size_t axes = task_.plan.axes().size();
  if (values_.size() == axes && std::equal(values_.begin(), values_.end(), values)) return false;
  values_.clear();
  scenario_ = task_.family.read(task_.plan.settings(number));
  values_.assign(values, values + axes);
  if (task_.windows != nullptr && !task_.windows->events) remove_events(scenario_);
  return true;
}

const Scenario& CaseScenario::at(std::size_t number, const double* values) {
  if (put(number, values)) window_.reset();
  if (task_.windows == nullptr) return scenario_;
  const Windows& windows = *task_.windows;
  const bool cut = windows.cut();
  if (cut) {
    const double begin = windows.begin_of(number), end = windows.end_of(number, scenario_);
    if (!window_ || begin != begin_ || end != end_) {
      window_.reset();
      window_ = window_of(scenario_, begin, end);
      begin_ = begin;
      end_ = end;
    }
  }
  Scenario& scene = cut ? *window_ : scenario_;
  if (!windows.start.empty()) set_start(scene, windows.start[number]);
  return scene;
}

}  // namespace bbsim::sweep
