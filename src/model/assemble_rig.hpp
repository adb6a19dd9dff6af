// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds the rig of a scene with a controller.
#pragma once

#include <functional>

#include "model/control/linear_system.hpp"
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

}  // namespace bbsim::model
