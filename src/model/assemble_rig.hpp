// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The parts of a built rig that a scenario names.
#pragma once

#include <functional>

#include "model/control/linear_system.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// Whether the loop is more than equation (31) with an ideal servo on the paper's gimbal.
[[nodiscard]] bool needs_rig(const Scenario& scene);

// The limit of the controller's command for an axis, rad or rad/s^2; gravity compensation has one
// of its own if none is given.
[[nodiscard]] std::optional<double> command_limit(const Controller& controller, std::size_t axis);

// Whether the loop integrates the error as a state: a law in continuous time with an integral.
[[nodiscard]] bool integrates_error(const Scenario& scene);

template <bool integrates, class Link = Direct>
struct AssembledRig {
  RigLoop<integrates, SignalPair, Link> loop;
  Rig rig;
};

// The plant about home behind servos that respond so.
using PlantOf = std::function<LinearPlant(const ServoResponses&)>;

// The scene has a controller; Link is what is between its servos and the plane, and Linkages may be
// nothing. `plant` is what LQR gains are of: by default a RigLoop's. Throws InputError where no LQR
// gain stabilises it, and where a linkage does not close.
template <bool integrates, class Link = Direct>
[[nodiscard]] AssembledRig<integrates, Link> assemble_rig(const Scenario& scene,
                                                          SignalPair reference,
                                                          const PlantOf& plant = {});

}  // namespace bbsim::model
