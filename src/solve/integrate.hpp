// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates a model with a given method, or with one that bbsim chooses.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

// Makes a stepper for runs of the model with rows at the times of the grid. `method` must not be
// automatic (see choose_method()). The stepper keeps a reference to the model. Throws InputError if
// the environment variable BBSIM_SIMD is set, but not to an instruction set of this processor.
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(const model::Model& model, Method method,
                                                    Tolerances tolerances, const OutputGrid& grid);

// Integrates from t = 0 to the end of the grid and passes each output row to `sink`.
//
// `method` may be automatic.
//
// A run that cannot go on returns Ending::failed with the rows that it reached. Throws what `sink`
// throws. Throws InputError as make_stepper() does.
[[nodiscard]] Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                                const OutputGrid& grid, StateSink& sink, const Watch& watch = {});

// The same for a run that pauses: each call goes on to the end, or returns nothing at a sample for
// which an external controller has no answer yet (HybridRun::advance()). References must live.
[[nodiscard]] std::function<std::optional<Outcome>()> begin(const model::Model& model,
                                                            Method method, Tolerances tolerances,
                                                            const OutputGrid& grid, StateSink& sink,
                                                            const Watch& watch);

}  // namespace bbsim::solve
