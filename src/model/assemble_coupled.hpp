// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes with couples, sliding or torques, from their parts.
#pragma once

#include <optional>
#include <vector>

#include "model/model.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// What the scene names beyond ideal rolling.
struct CoupledScene {
  System system;
  std::optional<Rig> rig{};       // of a controller
  std::optional<DryParts> dry{};  // where something of it switches
};

// The scene is one for which scenario::is_coupled() or scenario::is_linked() holds; `input` is the
// given motion or torque, or what the controller follows. Throws InputError as assemble_rig() does.
[[nodiscard]] CoupledScene assemble_coupled(const Scenario& scene, SignalPair input);

// Times at which derivatives of the push on the ball jump, s.
[[nodiscard]] std::vector<double> push_knots(const Scenario& scene);

// The states at the start.
[[nodiscard]] std::vector<double> initial_coupled_state(const Scenario& scene);

}  // namespace bbsim::model
