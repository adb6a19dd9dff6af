// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sweep, ready to be run, and what comes of its cases.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "controller/child.hpp"
#include "scenario/family.hpp"
#include "scenario/measures.hpp"
#include "sweep/plan.hpp"

namespace bbsim::sweep {

struct SweepTask {
  const ScenarioFamily& family;
  const SweepPlan& plan;
  std::vector<scenario::Measure> measures;
  // Columns of the output rows that are kept of each case too; all cases must have as many rows.
  std::vector<const scenario::Column*> series{};
  std::size_t series_rows = 0;
  // Gets what controllers that are programs say on their standard error, from all threads.
  controller::Tell tell = [](std::string_view) {};
};

// How a case ended.
struct CaseStatus {
  std::string word = "done";  // or failed, stopped, inaccurate, refused
  // Why it ended early, or why a measure of a case that is done is no finite number: a text of any
  // characters.
  std::string reason{};
};

// Some cases, one after the other.
struct CaseResults {
  std::size_t first = 0, count = 0;
  std::vector<double> values;   // of the axes: count x axes
  std::vector<double> numbers;  // the time reached (s), then the measures: count x (1 + measures)
  std::vector<CaseStatus> status;
  // For each column of the series, count x rows; what a case did not reach is no number.
  std::vector<std::vector<double>> series;
  std::string text;  // the rows as whoever takes them wants them

  void resize(std::size_t cases, const SweepTask& task);
  // Keeps the first of them.
  void cut(std::size_t cases, const SweepTask& task);
};

// Runs cases on one thread.
class CaseRunner {
 public:
  virtual ~CaseRunner() = default;
  // Cases first ... first + count - 1, all of them in whole groups but for the sweep's last ones.
  // Returns how many were run, less than `count` only if `stop` became true: whole groups too.
  virtual std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                          const std::atomic<bool>& stop) = 0;
};

}  // namespace bbsim::sweep
