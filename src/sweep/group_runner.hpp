// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Cases that go together in lanes, a group at a time, and those that do not fit by themselves.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "scenario/scenario.hpp"
#include "sweep/task.hpp"

namespace bbsim::sweep {

struct GroupCase {
  std::size_t number;    // in the sweep
  const double* values;  // of the axes
  double* measures;      // where they go
  bool carried = false;  // as far as it goes, and the measures are there
  // Where the motion grew without bound, s; none where it went to the end.
  std::optional<double> unbounded_at = {};
};

// What carries a group of cases in lanes.
class GroupCarrier {
 public:
  virtual ~GroupCarrier() = default;
  // One group, or fewer at the sweep's end. Cases that are not marked as carried are run alone.
  // May return when `stop` becomes true.
  virtual void carry(std::span<GroupCase> cases, const std::atomic<bool>& stop) = 0;
};

// `first` is the sweep's first case: those that are carried end at the same time, and have all
// measures. The task outlives the runner.
[[nodiscard]] std::unique_ptr<CaseRunner> group_runner(const SweepTask& task, const Scenario& first,
                                                       std::size_t group,
                                                       std::unique_ptr<GroupCarrier> carrier);

}  // namespace bbsim::sweep
