// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Evaluation of existing results: measures, differences, statistics.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

struct Measured {
  std::vector<std::pair<std::string, double>> values;
  // About likely mistakes of the user, and values that are not finite.
  std::vector<std::string> notes;
};

// Measures of a run's result, which messages call `file`; `lists` are for
// scenario::split_measures(). Throws InputError.
[[nodiscard]] Measured measure(results::Result result, const std::string& file,
                               const std::vector<std::string>& lists);

struct CompareRequest {
  std::string a{}, b{};
  std::optional<double> rtol{}, atol{};  // without either: from the files' solver settings
  std::vector<std::string> columns{};    // empty: all
  results::LogChoice log{};              // if given, `a` is the log of a rig, and `b` a run
  std::optional<Scenario> run{};         // run for `b` if that is no result; `a` is then a log
};

struct Compared {
  bool alike = false;
  ExitCode code = ExitCode::done;     // of a scenario's run
  std::string reason;                 // why that run ended early; empty if it did not
  std::string text;                   // table of the columns, then the verdict
  std::vector<std::string> warnings;  // about the log, and columns that look like other units
};

// Compares two results row by row, or a log's rows with the run at their times. A log is alike
// unless `rtol` or `atol` is exceeded. An interrupted run leaves no text. Throws InputError, and
// ControllerFault for a run.
[[nodiscard]] Compared compare(const CompareRequest& request, Watch& watch);

// Note about a log that was aligned with a run.
[[nodiscard]] std::string moved_text(const std::string& log, double offset);

struct SummarizeRequest {
  std::string file;                         // the result of a sweep
  std::vector<std::string> keys, measures;  // lists; no measures: all
  std::vector<double> quantiles{0.05, 0.25, 0.5, 0.75, 0.95};
};

// CSV: a row for each measure of each group of cases. Throws InputError.
[[nodiscard]] std::string summarize(const SummarizeRequest& request);

}  // namespace bbsim::api
