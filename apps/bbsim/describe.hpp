// Sentences about a model and its run, shared by `run` and `check`.
#pragma once

#include <string>

#include "model/model.hpp"
#include "model/spectrum.hpp"
#include "solve/outcome.hpp"

namespace bbsim::app {

// A number in the shortest form that a person reads with pleasure: up to six digits.
[[nodiscard]] std::string short_number(double value);

// "5 states: x, y, vx, vy, r*spin"
[[nodiscard]] std::string states_line(const model::Model& model);

// "-15.5, -2.27 +- 8.45i, -0.001"
[[nodiscard]] std::string poles_line(const model::Eigenvalues& poles);

// One warning sentence if the closed loop is unstable about home, else an empty string.
[[nodiscard]] std::string instability_warning(const model::Model& model);

// Why a run failed: when, what the integrator said, what grew, and what to do.
[[nodiscard]] std::string failure_text(const model::Model& model, const solve::Outcome& outcome,
                                       double end);

}  // namespace bbsim::app
