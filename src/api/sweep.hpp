// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of a scenario at many values of its keys, and the merge of a sweep's parts. Runs
// with values, times and starts of their own, as arrays.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "file/table.hpp"
#include "scenario/family.hpp"
#include "sweep/case_rows.hpp"
#include "sweep/merge.hpp"
#include "sweep/task.hpp"

namespace bbsim::api {

// Replaces parts of a scenario's sweep; what is empty replaces nothing.
struct SweepChoice {
  std::vector<Variation> vary;
  std::string combine;  // "grid" or "zip"
  std::optional<double> samples, seed;
  std::vector<std::string> measures;  // names, or names with commas between them
};
// Throws InputError.
[[nodiscard]] Sweep with_choice(Sweep sweep, const SweepChoice& choice);

struct Shard {
  std::size_t number = 1, of = 1;
};

constexpr double most_threads = 1024;

struct SweepRequest {
  std::string file{};  // the scenario's, as the user gave it; "-": standard input
  const ScenarioFamily* family = nullptr;
  Sweep sweep{};
  Shard shard{};
  std::string output{};  // for sweep::CaseFile; empty: the result's table
  // The user did not name the output: messages say so, and unless `replaces_anything`, only a table
  // with the same columns is replaced.
  bool by_default = false, replaces_anything = false;
  std::string summary{};              // a JSON file; empty: none
  double threads = 0;                 // at most most_threads; 0: as many as processors
  bool resumes = false;               // continue a part that an earlier run left
  bool keeps_rows = false;            // also keep the rows of output.columns of each case
  std::vector<std::string> expect{};  // "max_tilt < 5 deg", of every case
  std::string script{};               // written in place of a run, for check_sweep(); or empty
};

struct SweepResult {
  // done; interrupted; ended_early if an expectation fails in a case.
  ExitCode code = ExitCode::done;
  std::string reason;              // why the sweep did not finish
  std::vector<std::string> unmet;  // expectations that fail, and in how many of the rows
  std::size_t cases = 0;           // in this shard
  std::size_t rows = 0, kept = 0;  // rows now there, and those kept from an earlier run
  sweep::StatusCounts statuses;    // of the rows
  std::string repeat;              // the first failed case and the command that repeats it, if any
  std::string engine, output;
  file::Table table;  // if the request names no output; columns of texts have no numbers
  double seconds = 0;
};

struct SweepSize {
  std::size_t cases = 0;
  std::size_t shards = 0;  // the most that all have cases
};
// Checks all cases of a sweep and the names of its files, and runs nothing. Throws InputError.
[[nodiscard]] SweepSize check_sweep(const SweepRequest& request, Watch& watch);

// Throws InputError, OutputError, and ControllerFault if the scene's own controller does not begin.
[[nodiscard]] SweepResult sweep(const SweepRequest& request, Watch& watch);

// Joins the parts of a sweep into the file that one run of it would have written. Throws InputError
// and OutputError.
[[nodiscard]] sweep::Merged merge(const std::vector<std::string>& parts, const std::string& output,
                                  Watch& watch);

struct CasesRequest {
  const ScenarioFamily& family;
  std::size_t count;                                // of cases
  std::vector<sweep::SweepPlan::ListedKey> keys{};  // that differ between the cases
  std::vector<std::string> columns{}, measures{};
  std::optional<sweep::CaseTimes> times{};  // of the columns; empty: the scenario's output times
  sweep::Windows windows{};
  double threads = 0;    // at most most_threads; 0: as many as processors
  bool in_lanes = true;  // false: columns of each case as a run has them, to the bit
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
