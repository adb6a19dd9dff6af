// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The input of a sweep, with times of the user's and measures, and the results of its cases.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "controller/child.hpp"
#include "file/table_writer.hpp"
#include "scenario/expectation.hpp"
#include "scenario/family.hpp"
#include "scenario/measures.hpp"
#include "solve/output_grid.hpp"
#include "sweep/plan.hpp"
#include "sweep/window.hpp"

namespace bbsim::sweep {

// Times of the columns, by the scenario's clock: one list for all cases, or one for each.
struct CaseTimes {
  std::vector<double> values{};  // s; lists that do not decrease, one after the other
  std::size_t count = 0;         // in a list
  bool each = false;

  [[nodiscard]] std::span<const double> of(std::size_t number) const {
    return std::span(values).subspan(each ? number * count : 0, count);
  }
};

// The output rows of a run at some times: the start, each time once, and the end.
struct TimedRows {
  solve::OutputGrid grid;
  // Row r is at the times first[r] to first[r + 1] - 1 of the list. Times outside of the run have
  // no row.
  std::vector<std::size_t> first;
};

// `times` do not decrease. The run covers `begin` to `end` (s); its own clock starts at 0.
[[nodiscard]] TimedRows rows_at(std::span<const double> times, double begin, double end);

// Whether `time` is `bound`, or differs from it by rounding.
[[nodiscard]] bool is_same_time(double time, double bound);

// Writes a case's columns to its place in the series.
class SeriesWriter : public file::TableWriter {
 public:
  // `timed` tells the times of the rows; null: each row has one.
  SeriesWriter(std::vector<std::vector<double>>& series, std::size_t place, const TimedRows* timed)
      : series_(series), place_(place), timed_(timed) {}

  void append(std::span<const double* const> columns, std::size_t rows) override;
  void finish(const file::Attributes&) override {}

 private:
  std::vector<std::vector<double>>& series_;
  std::size_t place_;
  const TimedRows* timed_;
  std::size_t row_ = 0;
};

struct SweepTask {
  const ScenarioFamily& family;
  const SweepPlan& plan;
  std::vector<scenario::Measure> measures;
  // Columns of the output rows that are kept for each case. All cases must have the same number of
  // rows. A case that lacks a column is refused.
  std::vector<const scenario::Column*> series{};
  std::size_t series_rows = 0;
  // Whether lanes may compute the series: these then agree with runs within the tolerance only.
  bool series_in_lanes = false;
  // Times of the series, instead of those of the output rows; the task then has no measures.
  const CaseTimes* times = nullptr;
  std::vector<scenario::Expectation> expectations{};
  std::vector<std::size_t> expected{};  // the place of each one's measure
  const Windows* windows = nullptr;     // null: each case is a whole run of its scenario
  // Receives the standard error of controller programs, from all threads.
  controller::Report report = [](std::string_view) {};
};

// How a case ended.
struct CaseStatus {
  std::string word = "done";  // or failed, stopped, inaccurate, refused
  // Why the case ended early, or why a measure of a done case is not finite. Any characters may
  // occur.
  std::string reason{};
};

// The results of some consecutive cases.
struct CaseResults {
  std::size_t first = 0, count = 0;
  std::vector<double> values;   // count x axes
  std::vector<double> numbers;  // count x (1 + measures): the time reached (s), then the measures
  std::vector<CaseStatus> status;
  // For each series column, count x rows; NaN where a case did not reach the row.
  std::vector<std::vector<double>> series;
  std::string text;  // the rows as text, which `prepare` of run_sweep() may write

  // `cases` cases that have no results yet.
  void resize(std::size_t cases, const SweepTask& task);
  // Keeps the first `cases` cases.
  void cut(std::size_t cases, const SweepTask& task);
};

// Completes the status of a case once its run has ended. Sets measures that the case's scene lacks
// to NaN. In a case that is done, gives the reason for each measure that is not finite: the reason
// in `whys`, if there is one.
void judge(const SweepTask& task, const Scenario& scenario, double* measures, CaseStatus& status,
           const scenario::Whys& whys = {});

// Does the same for a case that is done and whose scene has all measures; most of these need no
// reason. The previous content of `status` does not matter.
void judge_done(const SweepTask& task, const double* measures, CaseStatus& status,
                const scenario::Whys& whys = {});

// Runs cases on one thread.
class CaseRunner {
 public:
  virtual ~CaseRunner() = default;
  // Runs cases first ... first + count - 1, in whole groups except at the end of the sweep. Returns
  // how many were run, in whole groups too: less than `count` only if `stop` became true.
  virtual std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                          const std::atomic<bool>& stop) = 0;
};

// The measures with these names. Throws InputError for a name given twice, and for a measure whose
// columns or window no case has. Tries the first case, then at most 4096 cases from all over the
// sweep.
[[nodiscard]] std::vector<scenario::Measure> sweep_measures(const std::vector<std::string>& names,
                                                            const ScenarioFamily& family,
                                                            const SweepPlan& plan);

}  // namespace bbsim::sweep
