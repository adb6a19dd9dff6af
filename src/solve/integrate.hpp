// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Model -> Trajectory, by the integrator asked for or the one that suits.
#pragma once

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/part.hpp"

namespace bbsim::solve {

// Integrates from t = 0 to the end of the grid and hands each output row to `sink`.
//
// `part`, which may be null, says that it is a part of a run (solve/part.hpp): by radau alone,
// other methods keep what they remember to themselves, and leave no state.
//
// `method` may be automatic. A run that cannot go on returns Ending::failed with the rows that it
// reached; exceptions come from the sink alone.
[[nodiscard]] Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                                const OutputGrid& grid, StateSink& sink, const Watch& watch = {},
                                Part* part = nullptr);

}  // namespace bbsim::solve
