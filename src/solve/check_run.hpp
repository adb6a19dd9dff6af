// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run to hold another one against: with other stages, and other steps.
#pragma once

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve {

struct CheckRun {
  int stages;  // of radau: 8, 12 or 16
  // Each way from one stop of the integrator to the next, where an input's derivative jumps or a
  // sample is taken, is cut into so many parts: these stops dictate the steps of any method at any
  // tolerance, which are then alike unless they are cut.
  int parts;
};

// Integrates by radau, in steps that end at the parts' ends too.
[[nodiscard]] Outcome integrate_check_run(const model::Model& model, CheckRun how,
                                          Tolerances tolerances, const OutputGrid& grid,
                                          StateSink& sink, const Watch& watch);

}  // namespace bbsim::solve
