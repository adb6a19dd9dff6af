// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/ball/dynamics.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "model/ball/rolling.hpp"

namespace bbsim::model {

using Eigen::Vector3d;

bool is_the_papers(const Scenario& scene) {
  return scene.gimbal.mounting == Mounting{} && scene.ball.inertia_factor == 0.4;
}

GeneralRolling general_rolling(const Scenario& scene) {
  const Mounting& mounting = scene.gimbal.mounting;
  const double turn = mounting.yaw - mounting.skew;
  GeneralRolling rolling;
  rolling.k = scene.ball.inertia_factor;
  rolling.height = mounting.height;
  rolling.cos_skew = std::cos(mounting.skew);
  rolling.sin_skew = std::sin(mounting.skew);
  rolling.cos_turn = std::cos(turn);
  rolling.sin_turn = std::sin(turn);
  rolling.cos_base = std::cos(mounting.base_tilt);
  rolling.sin_base = std::sin(mounting.base_tilt);
  return rolling;
}

BallConstants constants_of(const Scenario& scene) {
  BallConstants constants{scene.ball.radius, scene.ball.mass, scene.gravity};
  constants.papers_rig = is_the_papers(scene);
  constants.rolling = general_rolling(scene);
  GimbalBody& body = constants.body;
  if (scene.plate.inertia) std::ranges::copy(*scene.plate.inertia, body.plate);
  body.imbalance = scene.plate.mass * scene.plate.centre_of_mass;
  body.ring = scene.gimbal.ring_inertia;
  if (scene.gimbal.motor) {
    body.rotor = scene.gimbal.motor->rotor_inertia;
    if (const auto& dc = scene.gimbal.motor->dc) {
      constants.armature = {dc->resistance, dc->gear * dc->torque_constant};
    }
  }
  return constants;
}

namespace {

Vector3d packed(const Vector3<double>& a) {
  return {a.x, a.y, a.z};
}

// The quantities from which forces, torques and energy follow. All vectors are in the plane's
// frame.
struct Kinematics {
  Kinematics(const Sample& sample, const BallConstants& with)
      : constants(with),
        gimbal(sample.gimbal),
        ball(sample.ball),
        push(sample.push[0], sample.push[1], 0),
        coupled(sample.coupled ? &*sample.coupled : nullptr) {
    const auto [sin_phi, cos_phi] = sin_cos(gimbal.phi);
    const auto [s, c] = sin_cos(gimbal.theta);
    phi = {sin_phi, cos_phi, gimbal.phi_dot, gimbal.phi_ddot};
    theta = {s, c, gimbal.theta_dot, gimbal.theta_ddot};
    plane = moving_plane(constants.rolling, phi, theta);
    theta_axis = Vector3d(plane.theta_axis[0], plane.theta_axis[1], 0);
    phi_axis = packed(plane.phi_axis);
    up = packed(plane.up);
    omega = packed(plane.omega);
    contact = Vector3d(ball.x, ball.y, constants.rolling.height);
    centre = Vector3d(ball.x, ball.y, constants.rolling.height + constants.radius);
    velocity = Vector3d(ball.x_dot, ball.y_dot, 0);
  }

  // The ball's acceleration in the plane for this motion of the gimbal.
  [[nodiscard]] Vector3d relative(const GimbalAngle<double>& p,
                                  const GimbalAngle<double>& t) const {
    const double r = constants.radius, g = constants.gravity;
    const RollingState<double, double, double> state{ball.x, ball.y, ball.x_dot, ball.y_dot,
                                                     r * ball.gamma_dot};
    if (constants.papers_rig) {
      return {Equation27::x<double>(p, t, state, r, g), Equation27::y<double>(p, t, state, r, g),
              0};
    }
    const auto rates = constants.rolling.rates<double>(p, t, state, r, g);
    return {rates.x, rates.y, 0};
  }

  [[nodiscard]] Vector3d force() const {
    const Vector3d in_plane =
        coupled ? Vector3d(coupled->x_ddot, coupled->y_ddot, 0) : relative(phi, theta);
    return constants.mass * packed(force_by_mass(plane, ball, in_plane.x(), in_plane.y(),
                                                 constants.rolling.height, constants.radius,
                                                 constants.gravity)) -
           push;
  }

  const BallConstants& constants;
  const GimbalState& gimbal;
  const BallMotion& ball;
  Vector3d push;                 // on the ball's center, N
  const CoupledMotion* coupled;  // null unless the scene is coupled
  GimbalAngle<double> phi, theta;
  MovingPlane<double> plane;
  Vector3d theta_axis, phi_axis, up;   // up: the upward vertical
  Vector3d omega;                      // of the plane, rad/s
  Vector3d contact, centre, velocity;  // of the ball; velocity relative to the plane
};

}  // namespace

Vector3d contact_force(const Sample& sample, const BallConstants& constants) {
  return Kinematics(sample, constants).force();
}

Dynamics dynamics(const Sample& sample, const BallConstants& constants) {
  const Kinematics now(sample, constants);
  const double r = constants.radius, m = constants.mass, g = constants.gravity;
  const Vector3d& omega = now.omega;
  const Vector3d centre_velocity = now.velocity + omega.cross(now.centre);
  const Vector3d slip = now.coupled != nullptr
                            ? Vector3d(now.coupled->slip[0], now.coupled->slip[1], 0)
                            : Vector3d(Vector3d::Zero());
  const Vector3d rolling = now.velocity - slip;
  const Vector3d ball_omega =
      omega + Vector3d(-rolling.y() / r, rolling.x() / r, now.ball.gamma_dot);

  Dynamics result;
  result.force = now.force();
  // The moment about the gimbal's center that carries the ball.
  Vector3d moment = now.contact.cross(result.force);
  if (now.coupled != nullptr) moment += Vector3d(now.coupled->couple);
  result.torque_phi = now.phi_axis.dot(moment);
  result.torque_theta = now.theta_axis.dot(moment);
  result.kinetic_energy = m * centre_velocity.squaredNorm() / 2 +
                          constants.rolling.k / 2 * m * r * r * ball_omega.squaredNorm();
  result.potential_energy = m * g * now.centre.dot(now.up);

  result.push_power = now.push.dot(centre_velocity);
  const GimbalBody& body = constants.body;
  const Torques<double> of_plate = plate_torques(now.plane, now.phi, now.theta, body, g);
  result.plate_torque_phi = of_plate.phi;
  result.plate_torque_theta = of_plate.theta;
  const Vector3d inertia(body.plate);
  const double phi_rate = now.gimbal.phi_dot, theta_rate = now.gimbal.theta_dot;
  result.gimbal_energy =
      omega.dot(inertia.cwiseProduct(omega)) / 2 + body.imbalance * g * now.up.z() +
      (body.ring + body.rotor) * phi_rate * phi_rate / 2 + body.rotor * theta_rate * theta_rate / 2;
  if (now.coupled != nullptr) {
    result.coupled = *now.coupled;
    for (std::size_t i = 0; i < 2; ++i) {
      const double current = now.coupled->given[i] / constants.armature.torque_by_current;
      const double rate = i == 0 ? phi_rate : theta_rate;
      result.current[i] = current;
      result.voltage[i] =
          constants.armature.resistance * current + constants.armature.torque_by_current * rate;
    }
  }
  return result;
}

double tilt(const Sample& sample, const BallConstants& constants) {
  const Vector3d up = Kinematics(sample, constants).up;
  return std::atan2(std::hypot(up.x(), up.y()), up.z());
}

double tilt_rate(const Sample& sample, const BallConstants& constants) {
  // The axes of the paper's gimbal are square.
  if (constants.papers_rig) return std::hypot(sample.gimbal.phi_dot, sample.gimbal.theta_dot);
  return Kinematics(sample, constants).omega.norm();
}

double singularity_distance(const Sample& sample, const BallConstants& constants) {
  const Kinematics now(sample, constants);
  const auto at_rest = [](const GimbalAngle<double>& axis, double acceleration) {
    return GimbalAngle<double>{axis.sin, axis.cos, 0, acceleration};
  };
  const Vector3d rest = now.relative(at_rest(now.phi, 0), at_rest(now.theta, 0));
  const Vector3d by_phi = now.relative(at_rest(now.phi, 1), at_rest(now.theta, 0)) - rest;
  const Vector3d by_theta = now.relative(at_rest(now.phi, 0), at_rest(now.theta, 1)) - rest;
  return std::abs(by_phi.x() * by_theta.y() - by_theta.x() * by_phi.y()) /
         (constants.radius * constants.radius);
}

}  // namespace bbsim::model
