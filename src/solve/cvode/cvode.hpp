// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The adapter to CVODES (SUNDIALS' CVODE with quadratures): variable-order BDF or Adams.
#pragma once

#include <memory>

#include "model/model.hpp"
#include "solve/outcome.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

// Makes BDF (Method::bdf, orders 1 to 5) with Newton iterations, a dense solver and the exact
// Jacobian, or Adams-Moulton (Method::adams, orders 1 to 12) with fixed-point iterations. `method`
// must be one of these.
//
// Rows come from the method's own polynomial. gamma is a quadrature outside the nonlinear system.
// Keeps a reference to the model. Throws std::runtime_error if CVODES refuses its setup.
[[nodiscard]] std::unique_ptr<Stepper> make_cvode_stepper(const model::Model& model, Method method,
                                                          Tolerances tolerances);

}  // namespace bbsim::solve
