// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The core of a run, with its model assembled and its files open; and sentences about the run
// (run_text.cpp).
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

// Why a run failed: when, what the integrator reported, what grew, and what to do.
[[nodiscard]] std::string failure_text(const Scenario& scenario, const model::Model& model,
                                       const solve::Outcome& outcome);

// Why a run stopped: when, at which event, which key asks for it, and how the scene would run on.
[[nodiscard]] std::string stopped_text(const Scenario& scenario, const solve::Outcome& outcome);

// How often each event was noted, and when first; one line each, empty if none was.
[[nodiscard]] std::string noted_text(const std::vector<model::Occurrence>& occurrences);

// Remarks on the scenario, an unstable loop, and a ball that left its plate without an event.
[[nodiscard]] std::vector<std::string> warnings_of(const Scenario& scenario,
                                                   const model::Model& model, bool failed,
                                                   const std::optional<record::OffPlate>& left);

}  // namespace bbsim::api
