// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The middle of a run: its model is there and its files are open. And the sentences about it, of
// run_text.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "record/edge_note.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/part.hpp"
#include "study/sensitivity.hpp"

namespace bbsim::api {

struct RowsAndMeasures {
  std::vector<const scenario::Column*> columns;
  std::size_t finite_columns;  // the first ones, which have to be; the others are for a picture
  std::vector<scenario::Measure> measures;
  std::size_t measures_with_gradients = 0;  // the first ones
};

struct Simulation {
  RunResult result;                   // without what only the request knows
  std::vector<double> row_estimates;  // the error of each row, in a run with an error estimate, m
  std::vector<double> measures;
  scenario::Whys whys;          // of those that are no number
  std::vector<double> end_row;  // Recorder::end_row()
  // Of each key of the sensitivity, the derivatives of the first measures.
  std::vector<std::vector<double>> gradients{};
};

// Integrates the model, which what is wanted needs, and hands the rows to `writer`, which is left
// to be finished. A part of a run, if it is one, has what came of it; `sensitivity`, if not null,
// the derivatives of the rows.
[[nodiscard]] Simulation simulate(const Scenario& scenario, const model::Model& model,
                                  const solve::OutputGrid& grid, const RowsAndMeasures& wanted,
                                  file::TableWriter& writer, Watch& watch, solve::Part* part,
                                  study::Sensitivity* sensitivity);

// Why a run failed: when, what the integrator said, what grew, and what to do.
[[nodiscard]] std::string failure_text(const Scenario& scenario, const model::Model& model,
                                       const solve::Outcome& outcome);

// Why a run stopped: when, at what, which key says so, and how the scene would run on.
[[nodiscard]] std::string stopped_text(const Scenario& scenario, const solve::Outcome& outcome);

// How often each thing was noted, and when first; a line each, empty if nothing was.
[[nodiscard]] std::string noted_text(const std::vector<model::Occurrence>& occurrences);

// Remarks on the scenario, an unstable loop, and a ball that left its plate unwatched.
[[nodiscard]] std::vector<std::string> warnings_of(const Scenario& scenario,
                                                   const model::Model& model, bool failed,
                                                   const std::optional<record::OffPlate>& left);

}  // namespace bbsim::api
