// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/runners.hpp"

#include <algorithm>
#include <utility>

#include "scenario/independent.hpp"
#include "solve/collocation/shrinking.hpp"
#include "sweep/window.hpp"

namespace bbsim::sweep {
namespace {

class GroupRunner : public CaseRunner {
 public:
  GroupRunner(const SweepTask& task, const Scenario& first, std::size_t group,
              std::unique_ptr<LaneRunner> lanes)
      : task_(task),
        first_(first),
        group_(group),
        lanes_(std::move(lanes)),
        single_(single_runner(task)) {}

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    into.first = first;
    into.resize(count, task_);
    for (std::size_t i = 0; i < count; i += group_) {
      if (stop.load(std::memory_order_relaxed)) return i;
      const std::size_t in_group = std::min(group_, count - i);
      const std::size_t done = run_group(i, in_group, into, stop);
      if (done < in_group) return i + done;
    }
    return count;
  }

 private:
  // Returns how many cases were run before `stop` became true.
  std::size_t run_group(std::size_t place, std::size_t count, CaseResults& into,
                        const std::atomic<bool>& stop) {
    const std::size_t axes = task_.plan.axes().size(), numbers = 1 + task_.measures.size();
    cases_.clear();
    for (std::size_t i = place; i < place + count; ++i) {
      double* const values = into.values.data() + i * axes;
      task_.plan.values(into.first + i, values);
      cases_.push_back({into.first + i, values, &into.numbers[i * numbers] + 1, &into.series,
                        i * task_.series_rows});
    }
    lanes_->run(cases_, stop);
    for (const GroupCase& group_case : cases_) {
      const std::size_t at = group_case.number - into.first;
      double* const results = &into.numbers[at * numbers];
      CaseStatus& status = into.status[at];
      if (group_case.is_done) {
        results[0] = group_case.unbounded_at.value_or(first_.time.end);
        if (group_case.unbounded_at) {
          status = {"failed", solve::Shrinking::reason.text};
        } else {
          judge_done(task_, group_case.measures, status, group_case.whys);
        }
        continue;
      }
      // A case that the lanes left because of `stop` is not run singly either.
      if (stop.load(std::memory_order_relaxed)) return at - place;
      if (single_->run(group_case.number, 1, alone_, stop) == 0) return at - place;
      std::copy(alone_.numbers.begin(), alone_.numbers.end(), results);
      for (std::size_t c = 0; c < into.series.size(); ++c) {
        std::ranges::copy(alone_.series[c], into.series[c].data() + group_case.place);
      }
      status = alone_.status[0];
    }
    return count;
  }

  const SweepTask& task_;
  const Scenario first_;
  std::size_t group_;
  std::unique_ptr<LaneRunner> lanes_;
  std::unique_ptr<CaseRunner> single_;
  std::vector<GroupCase> cases_;
  CaseResults alone_;
};

}  // namespace

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

bool can_share_rows(const SweepTask& task) {
  return (task.series.empty() || task.series_in_lanes) &&
         (task.windows == nullptr || !task.windows->cut()) &&
         (task.times == nullptr || !task.times->each);
}

std::optional<TimedRows> timed_rows(const SweepTask& task, const Scenario& first) {
  if (task.times == nullptr) return {};
  return rows_at(task.times->of(0), 0, first.time.end);
}

std::unique_ptr<CaseRunner> group_runner(const SweepTask& task, const Scenario& first,
                                         std::size_t group, std::unique_ptr<LaneRunner> lanes) {
  return std::make_unique<GroupRunner>(task, first, group, std::move(lanes));
}

}  // namespace bbsim::sweep
