// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How the user's controller answers to a ball that is not at its reference.
#pragma once

#include "api/check.hpp"
#include "model/model.hpp"

namespace bbsim::api {

// Puts the ball beside the reference, on each axis and either side, and asks the model's controller
// for commands: where they drive the ball, and the gain. Whether they are right is for the model to
// say. Small pulses about the reference tell the law and so the loop's margins, as far as it is
// linear. Runs the controller about twenty times for at most a hundred samples. Throws
// model::ControllerFault.
[[nodiscard]] Report probe(const Scenario& scenario, const model::Model& model);

}  // namespace bbsim::api
