// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The core of a run, with its model assembled and its files open; and sentences about
// the run. Derivatives of a run by keys, from runs at neighboring values: `run --sensitivity`
// (docs/explanation/sensitivity.md).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "api/sweep.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"
#include "scenario/family.hpp"
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

struct SensitivityKey {
  std::string name;
  double value, step;  // of neighboring values
};

class Sensitivity {
 public:
  // For the states among the columns, and for the measures. Throws InputError for a key without a
  // number, and for a request that does not allow derivatives.
  Sensitivity(const RunRequest& request, const std::vector<const scenario::Column*>& columns,
              std::vector<scenario::Measure> measures);

  // Whether there is anything to derive.
  [[nodiscard]] bool wanted() const {
    return !keys_.empty() && !(columns_.empty() && measures_.empty());
  }
  // Columns d(x)/d(KEY).
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  void add_headers(std::vector<file::ColumnHeader>& headers) const;

  // Runs the neighbors. Returns the columns, with the rows of the run. Adds the gradients of
  // measures to its summary, and what is unreliable.
  [[nodiscard]] std::vector<std::vector<double>> find(RunResult& run, Watch& watch) const;

 private:
  [[nodiscard]] CasesResult run_neighbors(Watch& watch) const;

  std::vector<scenario::Measure> measures_;
  std::vector<const scenario::Column*> columns_;  // states only
  solve::OutputGrid grid_;
  std::unique_ptr<const ScenarioFamily> family_;  // with the solver of the neighbors
  std::vector<SensitivityKey> keys_;
  std::vector<std::string> names_, units_, meanings_;  // for each column, key after key
};

}  // namespace bbsim::api
