// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The values of keys at which a scenario is closest to logs of a rig.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "fit/fit.hpp"
#include "results/log.hpp"
#include "scenario/family.hpp"

namespace bbsim::api {

struct FitRequest {
  const ScenarioFamily& family;
  std::vector<std::string> logs;  // files
  results::LogChoice choice{};    // what their columns are
  std::vector<std::string> free;  // KEY or KEY=FROM:TO
  std::string window{};           // a time; empty: what suits the scene
  double hold_out = 0;            // a share of the windows, from 0 to below 1
  bool with_series = false;       // for fit_page()
  std::size_t threads = 0;        // 0: as many as there are processors
  std::size_t starts = 1;         // sets of values to begin with, from 1 on
  std::string loss = "squares";   // or huber
  bool continuity = false;        // windows join where no gap is between them
};

struct FitResult {
  ExitCode code = ExitCode::done;  // or interrupted, with the best so far, if there is any
  fit::Fitted fitted;
  std::vector<std::string> warnings;  // of the logs
  std::string text;                   // a report
  std::string json;
  std::string scenario;  // its text with the estimates in it, and what they are in comments
};

// Throws InputError. The fitted scenario's text is made only if it is asked for.
[[nodiscard]] FitResult fit(const FitRequest& request, bool with_scenario, Watch& watch);

}  // namespace bbsim::api
