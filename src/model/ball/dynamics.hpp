// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Accelerations, contact force, motor torques and energy at an instant (docs/explanation/model.md,
// "Forces, torques and energy").
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "model/ball/contact_force.hpp"
#include "model/sample.hpp"

namespace bbsim::model {

struct BallConstants {
  double radius = 0, mass = 1, gravity = 0;  // m, kg, m/s^2
  bool papers_rig = true;                    // use equation (27); otherwise `rolling`
  GeneralRolling rolling{};
  GimbalBody body{};
  struct Armature {
    double resistance = 0, torque_by_current = 1;  // ohm; N m/A, through the gear
  } armature{};
};

[[nodiscard]] BallConstants constants_of(const Scenario& scene);

struct Dynamics {
  // Force of the plane on the ball in the plane's frame, N; z is the normal force.
  Eigen::Vector3d force{0, 0, 0};
  double torque_phi = 0;                            // motor torque that carries the ball, N m
  double torque_theta = 0;                          // N m
  double kinetic_energy = 0, potential_energy = 0;  // J; potential: 0 at gimbal center
  double plate_torque_phi = 0;                      // motor torque for the plate itself, N m
  double plate_torque_theta = 0;                    // N m
  double gimbal_energy = 0;           // of plate, ring and rotors, kinetic and potential, J
  double push_power = 0;              // of the push on the ball, W
  CoupledMotion coupled{};            // set only in coupled scenes
  Pair current{0, 0}, voltage{0, 0};  // of the motors, A and V
  [[nodiscard]] double energy() const { return kinetic_energy + potential_energy; }
  [[nodiscard]] double normal_force() const { return force.z(); }
  [[nodiscard]] double friction_force() const { return force.head<2>().norm(); }
  // While the ball slides this is the coefficient of sliding friction, which stays defined at
  // lift-off, where both forces vanish.
  [[nodiscard]] double friction_demand() const {
    return std::isnan(coupled.sliding) ? friction_force() / normal_force() : coupled.sliding;
  }
};

// The force of the plane on the ball in the plane's frame, N; z is the normal force.
[[nodiscard]] Eigen::Vector3d contact_force(const Sample& sample, const BallConstants& constants);

[[nodiscard]] Dynamics dynamics(const Sample& sample, const BallConstants& constants);

// The angle between the plane's normal and the vertical, rad. Needs only the gimbal's angles.
[[nodiscard]] double tilt(const Sample& sample, const BallConstants& constants);

// The magnitude of the plane's angular velocity, rad/s. Needs only the gimbal's angles and rates.
[[nodiscard]] double tilt_rate(const Sample& sample, const BallConstants& constants);

// |det M| / r^2, where M is the derivative of (x'', y'') with respect to (phi'', theta''): (M32).
// On the paper's rig |7 r cos theta + 5 y sin theta| / (7 r): (28), (29). At 0, M is singular.
[[nodiscard]] double singularity_distance(const Sample& sample, const BallConstants& constants);

}  // namespace bbsim::model
