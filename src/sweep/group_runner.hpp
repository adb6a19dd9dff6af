// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs groups of cases in lanes, and the cases that do not fit one by one.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scenario/scenario.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {

struct GroupCase {
  std::size_t number;    // of the case, in the sweep
  const double* values;  // one number for each axis
  double* measures;      // the results
  // The series of all cases, and where this one's begin.
  std::vector<std::vector<double>>* series;
  std::size_t place;
  bool is_done = false;      // run to its end, with its measures and series written
  scenario::Whys whys = {};  // why measures are not finite, if known
  // Time at which the motion grew without bound, s; empty if it reached the end.
  std::optional<double> unbounded_at = {};
};

// Whether lanes may hold the rows: all cases have them at the same times if they end at the same
// time.
[[nodiscard]] bool can_share_rows(const SweepTask& task);
// Those rows, if the task has times of its own; `first` is as below.
[[nodiscard]] std::optional<TimedRows> timed_rows(const SweepTask& task, const Scenario& first);

// Integrates a group of cases in lanes.
class LaneRunner {
 public:
  virtual ~LaneRunner() = default;
  // Runs one group; the last group of the sweep may be smaller. Cases that it does not mark as
  // done are run singly. May return early once `stop` is true.
  virtual void run(std::span<GroupCase> cases, const std::atomic<bool>& stop) = 0;
};

// `first` is the scenario of the sweep's first case. All cases in lanes share its end time and have
// all measures. The task must outlive the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> group_runner(const SweepTask& task, const Scenario& first,
                                                       std::size_t group,
                                                       std::unique_ptr<LaneRunner> lanes);

}  // namespace bbsim::sweep
