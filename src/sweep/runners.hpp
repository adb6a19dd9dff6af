// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What runs the cases of a sweep, and what these runners share. A task must outlive its runner.
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

// Single runs: cases one by one, with the numbers of `bbsim run`, bit for bit.
[[nodiscard]] std::unique_ptr<CaseRunner> single_runner(const SweepTask& task);

// Whether open lanes (given motions, equation (27)) or lanes (loops, (31)) can run all cases, and
// all measures are usual measures (lanes.cpp).
[[nodiscard]] bool can_use_open_lanes(const SweepTask& task);
[[nodiscard]] bool can_use_lanes(const SweepTask& task);
// Requires one of these. Cases that the lanes give up are run singly. So are cases that grow
// without bound, if their motion is given or the sweep has a measure at the end other than x and y.
[[nodiscard]] std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task);
// The number of cases in a group.
[[nodiscard]] std::size_t lane_group();

// Whether solve::sampled::RigLanes can run most of 16 cases from all over the sweep, with all
// measures and series.
[[nodiscard]] bool can_use_rig_lanes(const SweepTask& task);
// Requires this. A case is run singly if it does not fit into its group or if an event happens in
// it.
[[nodiscard]] std::unique_ptr<CaseRunner> rig_lane_runner(const SweepTask& task);
[[nodiscard]] std::size_t rig_group();

// Whether the task asks only for measures of the loop, which need no run; and the same task without
// them.
[[nodiscard]] bool is_of_loop_only(const SweepTask& task);
[[nodiscard]] SweepTask task_of_motion(const SweepTask& task);
// `motion` runs the cases of task_of_motion(). It is null if the task asks only for measures of the
// loop; the end time is then NaN.
[[nodiscard]] std::unique_ptr<CaseRunner> loop_runner(const SweepTask& task,
                                                      std::unique_ptr<CaseRunner> motion);

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
// Those rows, if the task has its own times; `first` is the scenario of the sweep's first case.
[[nodiscard]] std::optional<TimedRows> timed_rows(const SweepTask& task, const Scenario& first);

// Integrates a group of cases in lanes.
class LaneRunner {
 public:
  virtual ~LaneRunner() = default;
  // Runs one group; the last group of the sweep may be smaller. Cases that it does not mark as
  // done are run singly. May return early once `stop` is true.
  virtual void run(std::span<GroupCase> cases, const std::atomic<bool>& stop) = 0;
};

// Runs groups of cases in lanes, and the cases that do not fit one by one. `first` is the scenario
// of the sweep's first case. All cases in lanes share its end time and have all measures. The task
// must outlive the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> group_runner(const SweepTask& task, const Scenario& first,
                                                       std::size_t group,
                                                       std::unique_ptr<LaneRunner> lanes);

// Makes the scenario of a case. Replaces numbers in place if no rule relates their keys to other
// keys; otherwise reads the scenario again.
class CaseScenario {
 public:
  explicit CaseScenario(const SweepTask& task);
  CaseScenario(const CaseScenario&) = delete;  // places_ point into scenario_
  CaseScenario& operator=(const CaseScenario&) = delete;

  // Returns the scenario of case `number`, valid until the next call: its window, if the task has
  // windows. `values` are the plan's values for that case, already checked.
  [[nodiscard]] const Scenario& at(std::size_t number, const double* values);

 private:
  // Sets the values of the keys; returns whether that may have changed the scenario.
  bool put(std::size_t number, const double* values);

  const SweepTask& task_;
  Scenario scenario_;
  bool in_place_ = true;
  std::vector<std::vector<double*>> places_;  // for each axis
  std::vector<double> values_;                // of scenario_, if they are not in place
  std::optional<Scenario> window_;            // of scenario_
  double begin_ = 0, end_ = 0;                // of window_, s
};

}  // namespace bbsim::sweep
