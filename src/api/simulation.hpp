// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The core of a run, with its model assembled and its files open; and sentences about the run.
#pragma once

#include <cstddef>
#include <vector>

#include "api/run.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "solve/output_grid.hpp"

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

// Integrates the model, which must provide what `wanted` needs. Passes the rows to `writer`, which
// the caller finishes.
[[nodiscard]] Simulation simulate(const Scenario& scenario, const model::Model& model,
                                  const solve::OutputGrid& grid, const RowsAndMeasures& wanted,
                                  file::TableWriter& writer, Watch& watch);

}  // namespace bbsim::api
