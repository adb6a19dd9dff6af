// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Many runs of a scenario at other values of its keys, and the parts of such a sweep as one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "scenario/family.hpp"
#include "sweep/case_rows.hpp"

namespace bbsim::api {

struct Shard {
  std::size_t number = 1, of = 1;
};

struct SweepRequest {
  std::string file;  // of the scenario, as the user named it; "-": standard input
  const ScenarioFamily& family;
  Sweep sweep;
  Shard shard{};
  std::string output;  // by sweep::open_case_file(); empty: into the result's table
  // The output's name is none that the user gave: how messages call it, and, unless told otherwise,
  // that only a table with the same columns is replaced.
  bool by_default = false, replaces_anything = false;
  std::string summary{};    // a JSON file; empty: none
  std::size_t threads = 0;  // 0: as many as there are processors
  bool resumes = false;     // goes on with a part that an earlier run left
  bool keeps_rows = false;  // also those of output.columns of each case
};

// The rows of a sweep, a column each.
struct SweepTable {
  struct Column {
    std::string name, unit;
    bool is_text = false;
    std::vector<double> numbers;
    std::vector<std::string> texts;
  };
  std::vector<Column> columns;
};

struct SweepResult {
  ExitCode code = ExitCode::done;  // or interrupted
  std::string reason;              // why it did not end
  std::size_t cases = 0;           // of this shard
  std::size_t rows = 0, kept = 0;  // that are there now, and of these those of an earlier run
  sweep::StatusCounts statuses;    // of these
  std::string engine, output;
  SweepTable table;  // of a request without an output
  double seconds = 0;
};

// Throws InputError, OutputError, and ControllerFault where the scene's own controller does not
// begin.
[[nodiscard]] SweepResult sweep(const SweepRequest& request, Watch& watch);

struct MergeResult {
  ExitCode code = ExitCode::done;  // or interrupted, with nothing written
  std::size_t cases = 0;
  std::string note;  // what the user should know of the parts; or empty
};

// Joins the parts of a sweep to the file that one run of it would have written. Throws InputError,
// OutputError.
[[nodiscard]] MergeResult merge(const std::vector<std::string>& parts, const std::string& output,
                                Watch& watch);

}  // namespace bbsim::api
