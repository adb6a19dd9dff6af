// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run of a scenario from its first row to its last; and the files that are read with it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "file/outputs.hpp"
#include "file/table_writer.hpp"
#include "model/control/external_controller.hpp"
#include "record/summary.hpp"
#include "replay/scene.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

using model::ControllerFault;

struct RunRequest {
  Scenario scenario;
  std::vector<file::InputTable> inputs{};  // tables that the scenario read
  // File for the rows of output.columns, for file::open_table(); empty: none.
  std::string output{};
  // Receives rows as they are computed; one pointer per column.
  std::function<void(std::span<const double* const> columns, std::size_t rows)> rows_to{};
  bool keeps_rows = false;  // keep the rows in the result even if they go elsewhere
  // Replace an existing output only if it is a table with these columns.
  bool replaces_its_like_only = false;
  std::string summary{};                // a JSON file; empty: none
  std::vector<std::string> measures{};  // lists of names, for scenario::split_measures()
  std::vector<std::string> expect{};    // "max_tilt < 5 deg"
  // Lists of keys, for split_measures(). Adds derivatives by them: of the states to the rows, of
  // `measures` to the summary.
  std::vector<std::string> sensitivity{};
  bool pictured = false;  // make what a page shows of the run
  // With `pictured`: also what `bbsim check` says, which takes longer than a short run.
  bool checked = true;
  // Called once the whole request has been checked, before files are opened.
  std::function<void()> ready = [] {};
};

struct RunResult {
  // done; interrupted; ended_early, also if an expectation fails.
  ExitCode code = ExitCode::done;
  // How the run ended and why, measures, events, peaks, warnings, statistics. Without rows no file
  // is written.
  record::RunSummary summary;
  std::size_t rows_requested = 0;
  std::vector<std::string> unmet;           // expectations that fail
  file::Table rows;                         // if the request keeps them or names no destination
  std::vector<std::string> columns, units;  // of output.columns
  std::string noted;                        // how often each event was noted; may be empty
  std::optional<replay::Run> pictured;
};

// Throws InputError, OutputError, and ControllerFault if the scene's own controller does not begin.
[[nodiscard]] RunResult run(const RunRequest& request, Watch& watch);

// The same for a run that pauses while its controller has no answer
// (model::ExternalController::has_answer()).
class PausingRun {
 public:
  // Begins the run. Throws as run() does. The arguments must live.
  PausingRun(const RunRequest& request, Watch& watch);
  ~PausingRun();
  PausingRun(const PausingRun&) = delete;
  PausingRun& operator=(const PausingRun&) = delete;

  // Goes on to the end, or to a sample without an answer. Returns whether it has reached the end.
  bool advance();
  // Finishes the files. Call it once, at the end.
  [[nodiscard]] RunResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// No output may overwrite what is read. Declares the scenario, its tables and the files of its
// controller as read.
void reads_scenario(file::Outputs& outputs, const std::string& file, const Scenario& scenario);

// Declares the files read with a result: its summary, and those that its scenario names.
void reads_with_result(file::Outputs& outputs, const results::Result& result);

}  // namespace bbsim::api
