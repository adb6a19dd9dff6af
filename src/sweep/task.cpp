// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/task.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/instant.hpp"
#include "base/real.hpp"

namespace bbsim::sweep {
namespace {

bool are_finite(const SweepTask& task, const double* measures) {
  return std::all_of(measures, measures + task.measures.size(),
                     [](double value) { return std::isfinite(value); });
}

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

bool is_same_time(double time, double bound) {
  return std::abs(time - bound) <= rounding_of(std::max(std::abs(time), std::abs(bound)));
}

TimedRows rows_at(std::span<const double> times, double begin, double end) {
  std::vector<double> rows{0};
  std::size_t i = 0;
  while (i < times.size() && times[i] < begin && !is_same_time(times[i], begin)) ++i;
  std::vector<std::size_t> first{i};
  for (; i < times.size() && (times[i] <= end || is_same_time(times[i], end)); ++i) {
    const double t = is_same_time(times[i], begin) ? 0
                     : is_same_time(times[i], end) ? end - begin
                                                   : times[i] - begin;
    if (!(t > rows.back())) continue;
    rows.push_back(t);
    first.push_back(i);
  }
  if (end - begin > rows.back()) {
    rows.push_back(end - begin);
    first.push_back(i);
  }
  first.push_back(i);
  return {solve::OutputGrid(std::move(rows)), std::move(first)};
}

void SeriesWriter::append(std::span<const double* const> columns, std::size_t rows) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double* const into = series_[c].data() + place_;
    if (timed_ == nullptr) {
      std::copy_n(columns[c], rows, into + row_);
      continue;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      const auto& first = timed_->first;
      std::fill(into + first[row_ + r], into + first[row_ + r + 1], columns[c][r]);
    }
  }
  row_ += rows;
}

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
