// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A function of time and states that is no system of ours, through CVODE.
#pragma once

#include <functional>
#include <vector>

#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::solve {

// z' = f(t, z), its type forgotten.
using Derivative = std::function<void(double t, const double* z, double* dz)>;

// Rows at the output times, by BDF with CVODE's difference quotients for the Jacobian; as many as
// the solution reaches. Starts again at each of the `stops`, where derivatives jump. Throws
// std::runtime_error if CVODE refuses to be set up.
[[nodiscard]] Trajectory integrate_by_bdf(Derivative derivative, const std::vector<double>& initial,
                                          const std::vector<double>& stops, Tolerances tolerances,
                                          const OutputGrid& grid, const Watch& watch);

}  // namespace bbsim::solve
