// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The middle of a run: its model is there and its files are open.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "solve/output_grid.hpp"
#include "solve/part.hpp"

namespace bbsim::api {

struct RowsAndMeasures {
  std::vector<const scenario::Column*> columns;
  std::size_t finite_columns;  // the first ones, which have to be; the others are for a picture
  std::vector<scenario::Measure> measures;
};

struct Simulation {
  RunResult result;                   // without what only the request knows
  std::vector<double> row_estimates;  // the error of each row, in a run with an error estimate, m
  std::vector<double> measures;
  scenario::Whys whys;          // of those that are no number
  std::vector<double> end_row;  // Recorder::end_row()
};

// Integrates the model, which what is wanted needs, and hands the rows to `writer`, which is left
// to be finished. A part of a run, if it is one, has what came of it.
[[nodiscard]] Simulation simulate(const Scenario& scenario, const model::Model& model,
                                  const solve::OutputGrid& grid, const RowsAndMeasures& wanted,
                                  file::TableWriter& writer, Watch& watch, solve::Part* part);

}  // namespace bbsim::api
