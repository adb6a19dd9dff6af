// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs a scene that switches, samples or watches for events, with any integrator.
#pragma once

#include <functional>
#include <memory>

#include "model/model.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

using MakeStepper = std::function<std::unique_ptr<Stepper>(const model::Model& model)>;

// Integrates from one switch to the next. Calls `make_stepper` once, with the model whose mode the
// run changes. `tolerances` are those of the stepper. The integrator stops at time events. A state
// event is the root of a guard on the step's polynomial, accurate to the rounding of the time.
//
// Rows have Model::row_size() numbers. A row exactly at a switch has the state after it. Returns
// Ending::stopped if an event stops the scene. Throws what `sink` throws, and InputError if `part`
// has a state that does not fit.
[[nodiscard]] Outcome integrate_hybrid(const model::Model& model, const MakeStepper& make_stepper,
                                       Tolerances tolerances, const OutputGrid& grid,
                                       StateSink& sink, const Watch& watch);

}  // namespace bbsim::solve
