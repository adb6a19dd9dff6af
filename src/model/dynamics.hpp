// Accelerations, contact force, motor torques and energy of one instant (docs/model.md, section 5).
#pragma once

#include <Eigen/Core>

#include "model/sample.hpp"

namespace bbsim::model {

struct BallConstants {
  double radius = 0, mass = 1, gravity = 0;  // m, kg, m/s^2
};

struct Dynamics {
  Eigen::Vector3d force;    // of the plane on the ball, plane frame, N; z is the normal force
  double torque_phi = 0;    // motor torque that carries the ball, N m
  double torque_theta = 0;  // N m
  double energy = 0;        // kinetic and potential, J; potential zero at the gimbal's centre
  [[nodiscard]] double normal_force() const { return force.z(); }
  [[nodiscard]] double friction_force() const { return force.head<2>().norm(); }
};

// All of it, from the state and the gimbal's motion alone.
[[nodiscard]] Dynamics dynamics(const Sample& sample, const BallConstants& constants);

}  // namespace bbsim::model
