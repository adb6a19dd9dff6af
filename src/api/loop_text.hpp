// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sentences about a loop about home: its poles, and whether it is stable.
#pragma once

#include <string>

#include "model/model.hpp"
#include "model/spectrum.hpp"

namespace bbsim::api {

// "-15.5, -2.27 +- 8.45i, -0.001"
[[nodiscard]] std::string poles_line(const model::Eigenvalues& poles);

// The poles of a sampled loop, as sizes in the unit circle.
[[nodiscard]] std::string sampled_poles_line(const model::Eigenvalues& poles);

// One warning sentence if the closed loop is unstable about home, else an empty string. `model` is
// the scenario's; where it would be stable with theta's gains of the other sign, that is said too.
[[nodiscard]] std::string instability_warning(const Scenario& scenario, const model::Model& model);

// Why poles of a sampled loop, or, `by_sample`, its equations from sample to sample, are without
// its camera's frames; empty if they are not.
[[nodiscard]] std::string without_frames(const Scenario& scenario, bool by_sample);

}  // namespace bbsim::api
