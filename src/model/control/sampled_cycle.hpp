// A rig about home as a linear system: for LQR gains and for the poles of sampled loops.
#pragma once

#include <Eigen/Core>

#include "model/spectrum.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// z' = A z + B u for z = (x, y, x', y', phi, theta, phi', theta') and the commands u, without
// limits, dead band and backlash. The spin, which does not act on them there, is left out.
struct LinearPlant {
  Eigen::Matrix<double, 8, 8> a;
  Eigen::Matrix<double, 8, 2> b;
};

[[nodiscard]] LinearPlant linear_plant(const RigLoop<>& loop);

// z and u after `time` (s) under a constant command: z(time) = a z + b u.
[[nodiscard]] LinearPlant after(const LinearPlant& plant, double time);

// The gain of Law::lqr: rows phi, theta; columns as z above. `period` > 0 for a sampled loop, whose
// delays the gain does not know. Throws InputError where no gain stabilises.
[[nodiscard]] Eigen::Matrix<double, 2, 8> lqr_gain(const LinearPlant& plant,
                                                   const LqrWeights& weights, double period);

// The poles of a sampled loop about home: eigenvalues of what a period does to the plant, to what
// is on its way through the delays, and to what the controller remembers. The loop is stable if all
// lie within the unit circle. By falling size; empty if the gains are too large for numbers.
[[nodiscard]] Eigenvalues sampled_poles(const RigLoop<>& loop, const Rig& rig);

}  // namespace bbsim::model
