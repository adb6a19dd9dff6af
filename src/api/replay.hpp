// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scene of a page that plays runs, sweeps and logs. A run for a live page: with measures, and
// the tasks of the scenario's exercise; and rigs like its own.
#pragma once

#include <cstddef>
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
#include "scenario/exercise.hpp"
#include "scenario/family.hpp"
#include "scenario/scenario.hpp"
#include "sweep/plan.hpp"

namespace bbsim::api {

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

class LiveRun {
 public:
  // Asks for what a live page shows of the request's scenario: the default measures, the bounds of
  // its exercise and, if the run is checked, metrics of a step and the measures of `sweep`. Throws
  // InputError for a mistaken exercise.
  explicit LiveRun(RunRequest& request);

  // What the page shows beside that run, without its loops. Finding the keys takes longer than a
  // short run.
  [[nodiscard]] replay::Live of(const RunResult& result, bool with_keys) const;

 private:
  Source source_;
  scenario::Exercise exercise_;
};

// The open loops of the scenario, which take longer than a short run; empty without a loop that
// bbsim can linearize.
[[nodiscard]] std::optional<replay::Live::Loops> loops_of(const Scenario& scenario);

// Rigs that differ by their tolerances: the drawn keys of the scenario's sweep or, if it has none,
// within 10 % of its numbers that a learner may change. Without numbers of time, output, solver,
// events and reference. Rigs of a seed are always the same. Throws InputError if there is nothing
// to draw.
[[nodiscard]] std::vector<sweep::SweepPlan::ListedKey> drawn_rigs(const ScenarioFamily& family,
                                                                  std::size_t count);

}  // namespace bbsim::api
