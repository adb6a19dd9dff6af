// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One run of a scenario, from its first row to its last.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "file/table_writer.hpp"
#include "model/control/external_controller.hpp"
#include "record/summary.hpp"
#include "replay/scene.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

using model::ControllerFault;

// The files of states, and the time at which the part ends; each may be empty.
struct PartRequest {
  std::string save, from, until;
  [[nodiscard]] bool any() const { return !save.empty() || !from.empty() || !until.empty(); }
};

struct RunRequest {
  Scenario scenario;
  std::vector<file::InputTable> inputs{};  // the tables that the scenario read
  // Where the rows of output.columns go, by file::open_table(); empty: nowhere.
  std::string output{};
  // Gets the rows as they come, by columns: a pointer each.
  std::function<void(std::span<const double* const> columns, std::size_t rows)> rows_to{};
  bool keeps_rows = false;  // the result has the rows, also where something else takes them
  // An existing output is replaced only if it is a table with these columns.
  bool replaces_its_like_only = false;
  std::string summary{};                // a JSON file; empty: none
  std::vector<std::string> measures{};  // lists of names, as scenario::split_measures() takes them
  std::vector<std::string> expect{};    // "max_tilt < 5 deg"
  // Lists of keys, as split_measures() takes them. Rows have the derivatives of the states by them,
  // the summary those of `measures`.
  std::vector<std::string> sensitivity{};
  PartRequest part{};
  bool pictured = false;  // the result has what a page shows of the run
  // Called once all that was asked for has been found in order, before files are opened.
  std::function<void()> ready = [] {};
};

struct RunResult {
  // done; ended_early, also where something is not as expected; interrupted.
  ExitCode code = ExitCode::done;
  // How the run ended and why, measures, events, peaks, warnings, statistics. Without any rows no
  // file is written.
  record::RunSummary summary;
  std::size_t rows_asked = 0;
  std::vector<std::string> unmet;  // what was expected of measures and is not so
  file::TableData rows;            // of a request that keeps them, or that says nowhere to put them
  std::vector<std::string> columns, units;  // of output.columns
  std::string noted;                        // how often each thing was noted; empty if nothing was
  std::string saved;  // what became of the file of a state; empty if none was wanted
  std::optional<replay::Run> pictured;
};

// Throws InputError, OutputError, and ControllerFault where the scene's own controller does
// not begin.
[[nodiscard]] RunResult run(const RunRequest& request, Watch& watch);

}  // namespace bbsim::api
