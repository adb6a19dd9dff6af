// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/task.hpp"

#include <algorithm>
#include <cmath>

#include "base/real.hpp"

namespace bbsim::sweep {
namespace {

bool are_finite(const SweepTask& task, const double* measures) {
  return std::all_of(measures, measures + task.measures.size(),
                     [](double value) { return std::isfinite(value); });
}

}  // namespace

void CaseResults::resize(std::size_t cases, const SweepTask& task) {
  series.resize(task.series.size());
  cut(cases, task);
  for (auto& column : series) std::ranges::fill(column, no_number);
}

void CaseResults::cut(std::size_t cases, const SweepTask& task) {
  count = cases;
  values.resize(cases * task.plan.axes().size());
  numbers.resize(cases * (1 + task.measures.size()));
  status.resize(cases);
  for (auto& column : series) column.resize(cases * task.series_rows);
}

void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status,
           const scenario::Whys& whys) {
  scenario::Whys reasons = whys;
  reasons.resize(task.measures.size(), nullptr);
  for (std::size_t m = 0; m < task.measures.size(); ++m) {
    if (const scenario::Missing lacks = scenario::missing(task.measures[m], scenario)) {
      measures[m] = no_number;
      reasons[m] = lacks.why;
    }
  }
  if (status.word != "done" || are_finite(task, measures)) return;
  status.reason = scenario::why_not_finite(task.measures, measures, reasons);
}

void judge_done(const SweepTask& task, const double* measures, CaseStatus& status,
                const scenario::Whys& whys) {
  if (status.word != "done" || !status.reason.empty()) status = {};
  if (are_finite(task, measures)) return;
  status.reason = scenario::why_not_finite(task.measures, measures, whys);
}

}  // namespace bbsim::sweep
