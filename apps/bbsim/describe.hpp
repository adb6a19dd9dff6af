// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sentences about a model and its run, shared by `run` and `check`.
#pragma once

#include <string>

#include "model/model.hpp"
#include "model/spectrum.hpp"
#include "solve/outcome.hpp"

namespace bbsim::app {

// A number in the shortest form that a person reads with pleasure: up to six digits.
[[nodiscard]] std::string short_number(double value);

// A number to so many digits, without an exponent where it is 1 or more: 12.3, 1230000.
[[nodiscard]] std::string rounded(double value, int digits);

// "5 states: x, y, vx, vy, r*spin"
[[nodiscard]] std::string states_line(const model::Model& model);

// "-15.5, -2.27 +- 8.45i, -0.001"
[[nodiscard]] std::string poles_line(const model::Eigenvalues& poles);

// One warning sentence if the closed loop is unstable about home, else an empty string. `model` is
// the scenario's; where it would be stable with theta's gains of the other sign, that is said too.
[[nodiscard]] std::string instability_warning(const Scenario& scenario, const model::Model& model);

// Why poles of a sampled loop, or, `by_sample`, its equations from sample to sample, are without
// its camera's frames; empty if they are not.
[[nodiscard]] std::string without_frames(const Scenario& scenario, bool by_sample);

// Why a run failed: when, what the integrator said, what grew, and what to do.
[[nodiscard]] std::string failure_text(const Scenario& scenario, const model::Model& model,
                                       const solve::Outcome& outcome);

// "the contact point left the plate, at x = 0.15 m, y = 0.02 m".
[[nodiscard]] std::string occurrence_text(const model::Occurrence& occurrence);

// Which key makes the scene stop there, and how it would run on.
[[nodiscard]] std::string stopping_text(const Scenario& scenario, const std::string& event);

// How often each thing was noted, and when first; a line each, empty if nothing was.
[[nodiscard]] std::string noted_text(const std::vector<model::Occurrence>& occurrences);

// The poles of a sampled loop, as sizes in the unit circle.
[[nodiscard]] std::string sampled_poles_line(const model::Eigenvalues& poles);

}  // namespace bbsim::app
