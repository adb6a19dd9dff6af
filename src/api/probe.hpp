// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Test of the user's controller with a ball away from its reference.
#pragma once

#include <optional>
#include <string>

#include "api/check.hpp"
#include "model/control/linearize.hpp"
#include "model/model.hpp"

namespace bbsim::api {

// Puts the ball beside the reference, on each axis and either side, and asks the model's controller
// for commands. The model tells where they drive the ball. Small pulses about the reference give
// the law, as far as it is linear, and the loop's margins. Runs the controller about twenty times
// for a hundred samples, or for as long as a ball needs to roll off if it does not answer before.
// Throws model::ControllerFault.
struct Probed {
  Report report;
  std::optional<model::Linearization> loop;  // estimated, as model::loop_with() gives it
  std::string why;                           // why there is no estimate
};
[[nodiscard]] Probed probe(const Scenario& scenario, const model::Model& model);

}  // namespace bbsim::api
