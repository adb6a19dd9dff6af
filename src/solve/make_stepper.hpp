// The integrators, by name.
#pragma once

#include <memory>

#include "model/model.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {

// Makes a stepper for runs of the model to `end` (s), at the latest. The method is none but radau,
// bdf or adams (choose_method); Stepper and model are one another's to the end. Throws InputError
// if the environment variable BBSIM_SIMD names no instruction set of this processor.
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(const model::Model& model, Method method,
                                                    Tolerances tolerances, double end);

}  // namespace bbsim::solve
