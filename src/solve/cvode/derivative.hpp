// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates any function of time and states with CVODE. It need not be a model::System.
#pragma once

#include <functional>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve {

// z' = f(t, z), type-erased.
using Derivative = std::function<void(double t, const double* z, double* dz)>;

// Returns rows at the output times, as many as the solution reaches. Uses BDF with CVODE's
// difference quotients as the Jacobian. Starts from the initial states of the model, and restarts
// at each of its stops. Throws std::runtime_error if CVODE refuses its setup.
[[nodiscard]] Trajectory integrate_by_bdf(Derivative derivative, const model::Model& model,
                                          Tolerances tolerances, const OutputGrid& grid,
                                          const Watch& watch);

}  // namespace bbsim::solve
