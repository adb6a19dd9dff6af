// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Fit of a scenario's keys to logs of a rig.
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
  results::LogChoice choice{};    // how to read their columns
  std::vector<std::string> free;  // KEY or KEY=FROM:TO
  std::string window{};           // a time; empty: one that suits the scene
  double hold_out = 0;            // share of the windows, from 0 to below 1
  bool with_series = false;       // for fit_page()
  std::size_t threads = 0;        // 0: as many as processors
  std::size_t starts = 1;         // sets of start values, at least 1
  std::string loss = "squares";   // or huber
  bool continuity = false;        // join windows that have no gap between them
};

struct FitResult {
  ExitCode code = ExitCode::done;  // or interrupted, with the best so far, if any
  fit::Fitted fitted;
  std::vector<std::string> warnings;  // about the logs
  std::string text;                   // a report
  std::string json;
  std::string scenario;  // text with the estimates, which comments explain
};

// Throws InputError. Makes the fitted scenario's text only on request.
[[nodiscard]] FitResult fit(const FitRequest& request, bool with_scenario, Watch& watch);

}  // namespace bbsim::api
