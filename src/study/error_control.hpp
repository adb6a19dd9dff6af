// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Chooses tolerances for an error bound in meters.
#pragma once

#include <vector>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {

struct ErrorControlled {
  solve::Outcome outcome;          // of the run whose rows the sink received
  solve::Tolerances tolerances{};  // of that run
  double estimate = 0;             // of its error: max |dx|, |dy| over the rows, m
  // The estimate for each of these rows, NaN for a row that no check run reached. Empty if there is
  // no estimate.
  std::vector<double> row_estimates;
  bool met = false;  // whether the estimate is within the bound
  int runs = 0;      // number of integrations
};

// Integrates so that x and y are within `bound` (m) at all output times
// (docs/explanation/error-control.md).
//
// Estimates a run's error by its distance from check runs with another number of stages and a much
// finer tolerance. They do not use the run's own error estimate. While the estimate exceeds the
// bound, the tolerance is tightened. If double precision cannot meet the bound, the sink receives
// the most accurate run, and `met` is false. All rows are held in memory.
//
// If a run fails or is interrupted, the sink receives the rows of that run. A later run that fails
// is dropped in favor of the best one before it.
[[nodiscard]] ErrorControlled integrate_to_error(const model::Model& model, Method method,
                                                 double bound, const solve::OutputGrid& grid,
                                                 solve::StateSink& sink,
                                                 const solve::Watch& watch = {});

}  // namespace bbsim::study
