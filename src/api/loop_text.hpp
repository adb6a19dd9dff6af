// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sentences about the loop near home: its poles, and whether it is stable.
#pragma once

#include <string>

#include "model/model.hpp"
#include "model/spectrum.hpp"

namespace bbsim::api {

// "-15.5, -2.27 +- 8.45i, -0.001"
[[nodiscard]] std::string poles_line(const model::Eigenvalues& poles);

// Poles of a sampled loop, as magnitudes relative to the unit circle.
[[nodiscard]] std::string sampled_poles_line(const model::Eigenvalues& poles);

// Warns if the closed loop of `model`, the scenario's, is unstable about home, and says if other
// signs of the gains, or a smaller ball, would make it stable. Else empty.
[[nodiscard]] std::string instability_warning(const Scenario& scenario, const model::Model& model);

// Why a sampled loop's poles (if `by_sample`, its equations by samples) leave out its camera's
// frames; empty if they do not.
[[nodiscard]] std::string without_frames(const Scenario& scenario, bool by_sample);

}  // namespace bbsim::api
