// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs a scene in which things switch, sample, or are watched for, with any integrator.
#pragma once

#include <functional>
#include <memory>

#include "model/model.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

using MakeStepper = std::function<std::unique_ptr<Stepper>(const model::Model& model)>;

// Integrates from one switch to the next, by a stepper that is made for the model which the run
// changes from mode to mode; `tolerances` are the stepper's. What does not depend on the state is a
// stop of the integrator; what does is the root of a guard on the step's own polynomial, to the
// rounding of the time.
//
// Rows are as long as Model::row_size() says. A row at the very time of a switch is of the instant
// after it. Ends with Ending::stopped where something happened that the scene stops at.
[[nodiscard]] Outcome integrate_hybrid(const model::Model& model, const MakeStepper& make_stepper,
                                       Tolerances tolerances, const OutputGrid& grid,
                                       StateSink& sink, const Watch& watch, Part* part = nullptr);

}  // namespace bbsim::solve
