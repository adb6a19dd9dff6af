// The parts of a built rig that a scenario names.
#pragma once

#include "model/rig/rig.hpp"

namespace bbsim::model {

// Whether the loop is more than equation (31) with an ideal servo on the paper's gimbal.
[[nodiscard]] bool needs_rig(const Scenario& scene);

struct AssembledRig {
  RigLoop<> loop;
  Rig rig;
};

// Of a scene that needs_rig(). Throws InputError where no LQR gain stabilises it.
[[nodiscard]] AssembledRig assemble_rig(const Scenario& scene, SignalPair reference);

}  // namespace bbsim::model
