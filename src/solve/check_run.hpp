// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Check runs: the same run with other stages and steps, from which `run --error` estimates its
// error (docs/explanation/error-control.md).
#pragma once

#include <cstddef>
#include <limits>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve {

struct CheckRun {
  int stages;  // 8, 12 or 16
  // The number of parts that each interval between two stops (jumps of an input derivative,
  // samples) is cut into. A stop ends a step of every method at every tolerance. Without the cuts,
  // a run and its check run would share these steps.
  int parts;
  // A run with more steps is given up.
  std::size_t most_steps = std::numeric_limits<std::size_t>::max();
};

// Integrates with radau and ends a step at the end of each part. Returns a failed Outcome if the
// run cannot go on. Throws what `sink` throws, and InputError as radau::choose_kernels() does.
[[nodiscard]] Outcome integrate_check_run(const model::Model& model, CheckRun how,
                                          Tolerances tolerances, const OutputGrid& grid,
                                          StateSink& sink, const Watch& watch);

}  // namespace bbsim::solve
