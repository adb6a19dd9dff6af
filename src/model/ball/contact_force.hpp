// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The contact force on a ball that rolls without losses, and the motor torques for ball and plate,
// for every number type (docs/explanation/model.md, "Forces, torques and energy"). All vectors are
// in the plane's frame.
#pragma once

#include "model/ball/general_rolling.hpp"

namespace bbsim::model {

template <class Real>
struct Vector3 {
  Real x, y, z;
};

template <class Real>
[[nodiscard]] inline Vector3<Real> cross(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
[[nodiscard]] inline Real dot(const Vector3<Real>& a, const Vector3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The plane's motion: the axes a_theta and a_phi about which the angles turn it, the upward
// vertical, its angular velocity Omega and acceleration; (M15) to (M17).
template <class Real, class Number = double>
struct MovingPlane {
  Number theta_axis[2];  // z: 0
  Vector3<Real> phi_axis, up, omega, omega_dot;
};

template <class Real, class Number>
[[nodiscard]] inline MovingPlane<Real, Number> moving_plane(const GeneralRollingOf<Number>& rolling,
                                                            const GimbalAngle<Real>& phi,
                                                            const GimbalAngle<Real>& theta) {
  const auto plane = rolling.kinematics(phi, theta);
  const auto& a = plane.theta_axis;
  const auto& b = plane.phi_axis;
  const auto& slope = plane.phi_axis_slope;
  const Real both = phi.rate * theta.rate;
  MovingPlane<Real, Number> motion{
      {a[0], a[1]}, {b[0], b[1], b[2]}, {plane.up[0], plane.up[1], plane.up[2]}, {}, {}};
  motion.omega = {a[0] * theta.rate + b[0] * phi.rate, a[1] * theta.rate + b[1] * phi.rate,
                  b[2] * phi.rate};
  motion.omega_dot = {a[0] * theta.acceleration + b[0] * phi.acceleration + slope[0] * both,
                      a[1] * theta.acceleration + b[1] * phi.acceleration + slope[1] * both,
                      b[2] * phi.acceleration + slope[2] * both};
  return motion;
}

// Contact force per mass of the ball, m/s^2: (M5). x_ddot, y_ddot: acceleration of the ball in the
// plane; height: of the plane above the gimbal's center, m; r: radius of the ball, m.
template <class Real, class Number, class Ball, class Scalar>
[[nodiscard]] inline Vector3<Real> force_by_mass(const MovingPlane<Real, Number>& plane,
                                                 const Ball& ball, const Real& x_ddot,
                                                 const Real& y_ddot, const Scalar& height,
                                                 const Scalar& r, const Scalar& g) {
  const Vector3<Real> centre{ball.x, ball.y, Real(height + r)};
  const Vector3<Real>& omega = plane.omega;
  const Vector3<Real> turned = cross(omega, cross(omega, centre));
  const Vector3<Real> swung = cross(plane.omega_dot, centre);
  return {x_ddot - 2 * (omega.z * ball.y_dot) + swung.x + turned.x + g * plane.up.x,
          y_ddot + 2 * (omega.z * ball.x_dot) + swung.y + turned.y + g * plane.up.y,
          2 * (omega.x * ball.y_dot - omega.y * ball.x_dot) + swung.z + turned.z + g * plane.up.z};
}

// The bodies that turn with the gimbal: the plate, the ring (with phi only), and the rotors.
struct GimbalBody {
  double plate[3] = {0, 0, 0};  // moments about the gimbal's center, along the plane's axes, kg m^2
  double imbalance = 0;         // mass times height of its center along the normal, kg m
  double ring = 0, rotor = 0;   // kg m^2
};

template <class Real>
struct Torques {
  Real phi, theta;  // N m
};

// The components of a moment about the gimbal's center along phi's and theta's axes.
template <class Real>
[[nodiscard]] inline Torques<Real> about_axes(const MovingPlane<Real>& plane,
                                              const Vector3<Real>& moment) {
  return {dot(plane.phi_axis, moment),
          plane.theta_axis[0] * moment.x + plane.theta_axis[1] * moment.y};
}

// The motor torques for the plate, the ring and the rotors: (M45) and (M46) without the ball.
template <class Real>
[[nodiscard]] inline Torques<Real> plate_torques(const MovingPlane<Real>& plane,
                                                 const GimbalAngle<Real>& phi,
                                                 const GimbalAngle<Real>& theta,
                                                 const GimbalBody& of, double g) {
  const auto by_inertia = [&of](const Vector3<Real>& a) {
    return Vector3<Real>{of.plate[0] * a.x, of.plate[1] * a.y, of.plate[2] * a.z};
  };
  const Vector3<Real> steady = by_inertia(plane.omega_dot);
  const Vector3<Real> gyral = cross(plane.omega, by_inertia(plane.omega));
  const double weight = of.imbalance * g;
  const Vector3<Real> moment{steady.x + gyral.x - weight * plane.up.y,
                             steady.y + gyral.y + weight * plane.up.x, steady.z + gyral.z};
  const Torques<Real> torques = about_axes(plane, moment);
  return {torques.phi + (of.ring + of.rotor) * phi.acceleration,
          torques.theta + of.rotor * theta.acceleration};
}

}  // namespace bbsim::model
