// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes the integrator for a method.
#pragma once

#include <memory>

#include "model/model.hpp"
#include "solve/output_grid.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

// Makes a stepper for runs of the model with rows at the times of the grid. `method` must not be
// automatic (see choose_method()). The stepper keeps a reference to the model. Throws InputError if
// the environment variable BBSIM_SIMD is set, but not to an instruction set of this processor.
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(const model::Model& model, Method method,
                                                    Tolerances tolerances, const OutputGrid& grid);

}  // namespace bbsim::solve
