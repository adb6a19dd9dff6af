// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Check runs: runs with other stages and other steps, from which `run --error` estimates its error
// (docs/explanation/error-control.md).
#pragma once

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve {

struct CheckRun {
  int stages;  // of radau: 8, 12 or 16
  // Each interval between two stops (an input derivative jumps, a sample is taken) is cut into this
  // many parts. Stops fix the steps of every method at every tolerance. Without the cuts, a run and
  // its check run would share these steps.
  int parts;
};

// Integrates by radau. Every part of an interval ends a step. Returns a failed Outcome where the
// run cannot go on. Throws what `sink` throws, and InputError as radau::choose_kernels() does.
[[nodiscard]] Outcome integrate_check_run(const model::Model& model, CheckRun how,
                                          Tolerances tolerances, const OutputGrid& grid,
                                          StateSink& sink, const Watch& watch);

}  // namespace bbsim::solve
