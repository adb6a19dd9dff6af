// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of a scenario with values, times and starts of their own, as arrays.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "scenario/family.hpp"
#include "sweep/task.hpp"

namespace bbsim::api {

struct CasesRequest {
  const ScenarioFamily& family;
  std::size_t count;                                // of cases
  std::vector<sweep::SweepPlan::ListedKey> keys{};  // that differ between the cases
  std::vector<std::string> columns{}, measures{};
  std::optional<sweep::CaseTimes> times{};  // of the columns; empty: the scenario's output times
  sweep::Windows windows{};
  double threads = 0;  // at most most_threads; 0: as many as processors
};

struct CasesResult {
  ExitCode code = ExitCode::done;  // or interrupted; cases without a status were not run
  std::size_t times = 0;           // of a case
  // For each column, count x times; for each measure, count. NaN where a case has no value.
  std::vector<std::vector<double>> columns, measures;
  std::vector<sweep::CaseStatus> status;  // for each case: done, stopped, failed or refused
};

// Runs cases in lanes if lanes carry the scenario, and no case has a window or its own times.
// Otherwise runs them one by one. At output times, and without windows, columns and measures are
// those of a sweep. Cases with bad values are refused; if all are, InputError has the faults of the
// first. Throws InputError, and ControllerFault if the scene's own controller does not begin.
[[nodiscard]] CasesResult run_cases(const CasesRequest& request, Watch& watch);

}  // namespace bbsim::api
