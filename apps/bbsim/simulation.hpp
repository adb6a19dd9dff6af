// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One run of a scenario from its first row to its last: for `run`, and for `replay` of a scenario.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/summary.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "scenario/scenario.hpp"
#include "solve/output_grid.hpp"
#include "solve/part.hpp"

namespace bbsim::app {

struct Simulation {
  // With status, reason and warnings, as it is to be told; `output` is left to whoever knows it.
  record::RunSummary summary;
  // The error of each row, in a run with an error estimate, m.
  std::vector<double> row_estimates;
  std::vector<double> measures;
  std::vector<double> end_row;     // Recorder::end_row()
  scenario::Whys whys;             // of those that are no number
  std::vector<std::string> unmet;  // what was expected of measures and is not so
  std::string noted;               // how often each thing was noted; empty if nothing was
  ExitCode code = ExitCode::done;
};

struct RowsAndMeasures {
  std::vector<const scenario::Column*> columns;
  std::size_t finite_columns;  // the first ones, which have to be; the others are for a picture
  std::vector<scenario::Measure> measures{};
};

// Integrates the model, which what is wanted needs, and hands the rows to `writer`, which is left
// to be finished. A part of a run, if it is one, has what came of it.
[[nodiscard]] Simulation simulate(const Scenario& scenario, const model::Model& model,
                                  const solve::OutputGrid& grid, const RowsAndMeasures& wanted,
                                  file::TableWriter& writer, bool quiet,
                                  solve::Part* part = nullptr);

// Says why the run ended early and what is not as expected, and, unless it is to be quiet, warnings
// and what was noted.
void tell(const Simulation& made, bool quiet);

}  // namespace bbsim::app
