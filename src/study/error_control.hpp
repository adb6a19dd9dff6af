// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// From metres of error to a method and its tolerances.
#pragma once

#include <vector>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {

struct ErrorControlled {
  solve::Outcome outcome;          // of the run whose rows the sink was given
  solve::Tolerances tolerances{};  // of that run
  double estimate = 0;             // of its error: max |dx|, |dy| over the rows, m
  // The estimate for each of these rows; for one that the second run did not reach it is no number.
  // None if there is no estimate.
  std::vector<double> row_estimates;
  bool met = false;  // whether the estimate is within the bound
  int runs = 0;      // integrations that it took
};

// Integrates so that x and y are within `bound` (m) at all output times.
//
// The error of a run is estimated by its distance from a second run with another number of stages
// and a tolerance far below, which knows nothing of the first run's own error estimate. While the
// estimate is above the bound the tolerance is tightened, until double precision gives no more:
// then the most accurate run's rows are given, and `met` is false. All rows are held in memory.
//
// A run that fails, or is interrupted, ends the matter: its rows are given.
[[nodiscard]] ErrorControlled integrate_to_error(const model::Model& model, Method method,
                                                 double bound, const solve::OutputGrid& grid,
                                                 solve::StateSink& sink,
                                                 const solve::Watch& watch = {});

}  // namespace bbsim::study
