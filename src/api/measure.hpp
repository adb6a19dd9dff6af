// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is found out about results that are there: measures, differences, statistics.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "results/log.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

struct Measured {
  std::vector<std::pair<std::string, double>> values;
  // Of what may not be as the user meant it, and of values that are no number.
  std::vector<std::string> notes;
};

// Measures of a run's result, which is called `file`; `lists` are those of
// scenario::split_measures(). Throws InputError.
[[nodiscard]] Measured measure(results::Result result, const std::string& file,
                               const std::vector<std::string>& lists);

struct CompareRequest {
  std::string a{}, b{};
  std::optional<double> rtol{}, atol{};  // without either, by the settings of the files' solvers
  std::vector<std::string> columns{};    // none: all
  results::LogChoice log{};              // if given, `a` is the log of a rig, and `b` a run
  std::optional<Scenario> run{};         // of `b`, if that is not a result; `a` is then a log
};

struct Compared {
  bool alike = false;
  ExitCode code = ExitCode::done;     // of a scenario's run
  std::string reason;                 // why that ended early; empty if it did not
  std::string text;                   // a table of the columns, then the verdict
  std::vector<std::string> warnings;  // of columns that look like other units, and of the log
};

// Compares two results row by row; or, of a log, its rows with the run at their times. A log is
// alike unless `rtol` or `atol` is exceeded. Of an interrupted run there is no text. Throws
// InputError, and ControllerFault of a run.
[[nodiscard]] Compared compare(const CompareRequest& request, Watch& watch);

// What to say of a log that was aligned with a run.
[[nodiscard]] std::string moved_text(const std::string& log, double offset);

struct SummarizeRequest {
  std::string file;                         // the result of a sweep
  std::vector<std::string> keys, measures;  // no measures: all; these are lists
  std::vector<double> quantiles{0.05, 0.25, 0.5, 0.75, 0.95};
};

// CSV: a row for each measure of each group of cases. Throws InputError.
[[nodiscard]] std::string summarize(const SummarizeRequest& request);

}  // namespace bbsim::api
