// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates a model with a given method, or with one that bbsim chooses.
#pragma once

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/partial_run.hpp"

namespace bbsim::solve {

// Integrates from t = 0 to the end of the grid and passes each output row to `sink`.
//
// `method` may be automatic. `part`, if not null, selects a part of the run
// (solve/partial_run.hpp). Only radau can save a state; other methods leave the part's state empty.
//
// A run that cannot go on returns Ending::failed with the rows that it reached. Throws what `sink`
// throws. Throws InputError as make_stepper() does, or if the state in `part` does not fit.
[[nodiscard]] Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                                const OutputGrid& grid, StateSink& sink, const Watch& watch = {},
                                PartialRun* part = nullptr);

}  // namespace bbsim::solve
