// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates a model with a given method, or with one that bbsim chooses.
#pragma once

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve {

// Integrates from t = 0 to the end of the grid and passes each output row to `sink`.
//
// `method` may be automatic.
//
// A run that cannot go on returns Ending::failed with the rows that it reached. Throws what `sink`
// throws. Throws InputError as make_stepper() does.
[[nodiscard]] Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                                const OutputGrid& grid, StateSink& sink, const Watch& watch = {});

}  // namespace bbsim::solve
