// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds the systems of scenes with couples, sliding, pushes or torques.
#pragma once

#include <optional>
#include <vector>

#include "model/model.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// The parts of a coupled scene.
struct CoupledScene {
  System system;
  std::optional<Rig> rig{};       // with a controller
  std::optional<DryParts> dry{};  // with dry friction, sliding or torque limits
};

// The scene must satisfy scenario::is_coupled() or scenario::is_linked(). `input` is the prescribed
// motion or torque, or the reference. Throws InputError as assemble_rig() does.
[[nodiscard]] CoupledScene assemble_coupled(const Scenario& scene, SignalPair input);

// Times at which a derivative of the push on the ball jumps, s.
[[nodiscard]] std::vector<double> push_knots(const Scenario& scene);

// The initial state, in the system's layout.
[[nodiscard]] std::vector<double> initial_coupled_state(const Scenario& scene);

}  // namespace bbsim::model
