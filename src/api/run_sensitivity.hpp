// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Derivatives of a run by keys, from runs at neighboring values: `run --sensitivity`
// (docs/explanation/sensitivity.md).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "api/sweep.hpp"

namespace bbsim::api {

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
