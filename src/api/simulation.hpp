// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The core of a run, with its model assembled and its files open; and sentences about the run.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "api/run.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/recorder.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "solve/output_grid.hpp"
#include "study/error_control.hpp"

namespace bbsim::api {

struct RowsAndMeasures {
  std::vector<const scenario::Column*> columns;
  std::size_t finite_columns;  // first columns, which must be finite; others are for a picture
  std::vector<scenario::Measure> measures;
};

struct Simulation {
  RunResult result;                   // without what only the request knows
  std::vector<double> row_estimates;  // error of each row, m, in a run with an error estimate
  std::vector<double> measures;
  scenario::Whys whys;          // of measures that are not finite
  std::vector<double> end_row;  // Recorder::end_row()
};

// What was integrated, and how well, as far as the run knows.
struct Integration : study::ErrorControlled {
  bool has_estimate = false;  // only for solver.error
  double cpu_seconds = 0;

  [[nodiscard]] bool within_error() const { return met || !has_estimate; }
};

class SimulatedRun {
 public:
  // The model must provide what `wanted` needs. Passes the rows to `writer`, which the caller
  // finishes. All arguments but `wanted` must live.
  SimulatedRun(const Scenario& scenario, const model::Model& model, const solve::OutputGrid& grid,
               RowsAndMeasures wanted, file::TableWriter& writer, Watch& watch);
  SimulatedRun(const SimulatedRun&) = delete;
  SimulatedRun& operator=(const SimulatedRun&) = delete;

  // Integrates to the end, or until an external controller has no answer yet. Returns whether it
  // has reached the end.
  bool advance();
  // Call it once, at the end.
  [[nodiscard]] Simulation finish();

 private:
  void take_measures(Simulation& into);

  const Scenario& scenario_;
  const model::Model& model_;
  const solve::OutputGrid& grid_;
  RowsAndMeasures wanted_;
  Watch& watch_;
  model::BallConstants constants_;
  scenario::SplitMeasures split_;
  record::Recorder recorder_;
  std::optional<record::EdgeNote> edge_;
  solve::StateSink* sink_;
  solve::Watch solve_watch_;
  std::function<std::optional<solve::Outcome>()> integrate_;  // not for solver.error
  Integration integration_;
};

}  // namespace bbsim::api
