// The parts of a built rig that a scenario names.
#pragma once

#include <functional>

#include "model/control/sampled_cycle.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// Whether the loop is more than equation (31) with an ideal servo on the paper's gimbal.
[[nodiscard]] bool needs_rig(const Scenario& scene);

// The limit of the controller's command, rad or rad/s^2; gravity compensation has one of its own if
// none is given.
[[nodiscard]] std::optional<double> command_limit(const Controller& controller);

// Whether the loop integrates the error as a state: a law in continuous time with an integral.
[[nodiscard]] bool integrates_error(const Scenario& scene);

template <bool integrates>
struct AssembledRig {
  RigLoop<integrates> loop;
  Rig rig;
};

// The plant about home behind servos that respond so.
using PlantOf = std::function<LinearPlant(const ServoResponse&)>;

// The scene has a controller. `plant` is what LQR gains are of: by default a RigLoop's. Throws
// InputError where no LQR gain stabilises it.
template <bool integrates>
[[nodiscard]] AssembledRig<integrates> assemble_rig(const Scenario& scene, SignalPair reference,
                                                    const PlantOf& plant = {});

}  // namespace bbsim::model
