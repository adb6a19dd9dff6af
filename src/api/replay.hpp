// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scene of a page that plays runs, sweeps and logs.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "api/watch.hpp"
#include "file/outputs.hpp"
#include "file/table_writer.hpp"
#include "record/summary.hpp"
#include "replay/scene.hpp"
#include "results/result.hpp"
#include "scenario/columns.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// These columns, followed by others that a picture of the scene needs.
[[nodiscard]] std::vector<const scenario::Column*> with_pictured(
    const std::vector<const scenario::Column*>& columns, const Scenario& scenario);

// Run of the scenario for a page; `end_row` is that of record::Recorder.
[[nodiscard]] replay::Run run_of(const Scenario& scenario, file::Table rows,
                                 record::RunSummary summary, const std::vector<double>& end_row,
                                 bool checked);

struct ReplayRequest {
  // A scenario, whose file ends in .yaml or .yml, or a result: a file, or one in memory with its
  // name as the file.
  struct Shown {
    std::string file;
    std::optional<results::Result> result{};
  };
  std::vector<Shown> shown;
  std::vector<std::string> logs;  // of real rigs, shown with the runs
  results::LogChoice log{};       // its maps: one for all logs, or one for each
  results::Beside beside{};       // its overrides also apply to scenarios
  std::string title{};            // empty: the scenario's
  bool live = false;              // with what a live page shows; of one scenario
  std::function<void(const std::string& file)> before_reading{};
  std::function<void()> before_running{};  // all files are read
};

struct ReplayResult {
  ExitCode code = ExitCode::done;  // of the first run that did not end well
  replay::Scene scene;
  std::vector<RunResult> runs;  // without their rows
};

// Whether the file's ending is that of a scenario.
[[nodiscard]] bool is_scenario(const std::string& file);

// Throws InputError with the faults of all files; the watch gets notes on logs.
[[nodiscard]] ReplayResult replay(const ReplayRequest& request, file::Outputs& outputs,
                                  Watch& watch);

// Run of a result, described by its scenario: fully if the scenario and its tables can still be
// read, else by the parts that can.
[[nodiscard]] replay::Run run_of(results::Result result, const std::string& name);

// Scene of one run, titled after the run or its name.
[[nodiscard]] replay::Scene scene_of(replay::Run run);

}  // namespace bbsim::api
