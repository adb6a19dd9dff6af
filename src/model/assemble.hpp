// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What assembles a Model (model.hpp): the rig of a scene with a controller, and the systems of
// scenes with couples, sliding, pushes or torques.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "model/control/linear_system.hpp"
#include "model/model.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// Whether the loop is more than equation (31) with an ideal servo on the paper's gimbal.
[[nodiscard]] bool needs_rig(const Scenario& scene);

// The limit of the controller's command for an axis, in the command's unit. Gravity compensation
// has a default limit, rad.
[[nodiscard]] std::optional<double> command_limit(const Controller& controller, std::size_t axis);

// Whether the loop has the integral of the error as a state: a continuous law with an integral.
[[nodiscard]] bool integrates_error(const Scenario& scene);

template <bool integrates, class Link = Direct>
struct AssembledRig {
  RigLoop<integrates, SignalPair, Link> loop;
  Rig rig;
};

// The plant about home with the given servo responses.
using PlantOf = std::function<LinearPlant(const ServoResponses&)>;

// Builds the loop and the rig; the scene must have a controller. Link is the mechanism between
// servos and plane; Linkages also covers a direct drive. `plant` gives the plant for LQR, by
// default a RigLoop's. Throws InputError if no LQR gain stabilizes the plant, or if a linkage does
// not close.
template <bool integrates, class Link = Direct>
[[nodiscard]] AssembledRig<integrates, Link> assemble_rig(const Scenario& scene,
                                                          SignalPair reference,
                                                          const PlantOf& plant = {});

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

}  // namespace bbsim::model
