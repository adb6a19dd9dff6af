// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Newton's and Euler's equations of a ball with couples and friction at its contact, and the
// moments for ball and plate about the gimbal (docs/explanation/losses-and-torques.md).
//
// All results are linear in a Cause. One function therefore gives the accelerations on a prescribed
// gimbal, the columns of the inertia matrix H of (M47), and the force and couple at the contact.
// Dry friction acts along fixed or moving directions; DryFriction decides when they change.
//
// Couples and rotations along the plane are stored rotated by a quarter turn, so that they are
// parallel to the velocities: p = (r omega_y, -r omega_x) is the velocity at which the ball would
// roll, and (C_y, -C_x) / (m r) is an acceleration.
#pragma once

#include "base/real.hpp"
#include "model/ball/contact_force.hpp"
#include "model/ball/general_rolling.hpp"
#include "model/ball/rolling.hpp"

namespace bbsim::model {

// The losses at the contact.
struct ContactLaw {
  ContactLaw() = default;
  ContactLaw(const Losses& losses, double m, double r)
      : rolling(losses.rolling),
        viscous(losses.viscous / (m * r * r)),
        pivoting(losses.pivoting / r) {}

  double rolling = 0;   // coefficient of rolling resistance
  double viscous = 0;   // c_v / (m r^2), 1/s
  double pivoting = 0;  // l / r
  double sliding = 0;   // coefficient of sliding friction
  friend bool operator==(const ContactLaw&, const ContactLaw&) = default;
};

// Direction that dry friction opposes: the velocity's or, while the velocity is too small to have
// one, a fixed direction. `along` is close to the velocity's direction and sets its sign, so that a
// motion that comes to rest continues smoothly past zero until its end is located.
struct DryDirection {
  double moving = 0;  // 1: use the velocity's direction; 0: use `along`
  double along[2] = {0, 0};
};

// The contact's mode, constant between two switches.
struct ContactMode {
  bool slides = false;  // otherwise the ball rolls, and p is the velocity
  bool rests = false;   // rolling resistance keeps p at zero
  bool held = false;    // pivoting friction keeps the spin at zero
  DryDirection roll, slip;
  double turns = 0;  // sign of the spin, which pivoting friction opposes
};

template <class Real>
struct Directions {
  Real roll[2], slip[2];
};

template <class Real>
void direction(const DryDirection& of, const Real& x, const Real& y, Real (&into)[2]) {
  const double still = 1 - of.moving;
  const Real size =
      root_along(of.moving * (x * x + y * y) + Real(still), of.along[0] * x + of.along[1] * y);
  into[0] = of.moving * (x / size) + Real(still * of.along[0]);
  into[1] = of.moving * (y / size) + Real(still * of.along[1]);
}

// The plane's motion without the contributions of phi'' and theta''.
template <class Real>
struct PlaneMotion {
  Real axis[2][3], up[3];  // axes of phi and theta
  Real omega[3], omega_dot[3];
};

// Terms in which the accelerations are linear.
template <class Real>
struct Cause {
  Real omega_dot[3];  // of the plane, rad/s^2
  Real rest[3];       // A + g up without the terms in Omega'; m/s^2
  Real turn[3];       // r (Omega x omega_r), m/s^2
  Real drag[2];       // of the viscous couple, m/s^2
};

// Accelerations, and force and couple at the contact divided by the ball's mass.
template <class Real>
struct Answer {
  Real x, y, u;    // x'', y'' and u' = r gamma'', m/s^2
  Real slip[2];    // derivative of the slip velocity, m/s^2
  Real force[3];   // of the plane on the ball, m/s^2
  Real couple[3];  // (C_y, -C_x, C_n) / (m r), m/s^2
};

// Constants and equations of a scene.
struct CoupledBall {
  double r = 0, m = 1, g = 0;
  GeneralRolling rolling{};
  ContactLaw law{};
  GimbalBody body{};

  [[nodiscard]] double above() const { return r + rolling.height; }

  template <class Real>
  [[nodiscard]] PlaneMotion<Real> plane(const GimbalAngle<Real>& phi,
                                        const GimbalAngle<Real>& theta) const {
    const auto k = rolling.kinematics(phi, theta);
    PlaneMotion<Real> plane;
    const Real both = phi.rate * theta.rate;
    for (int i = 0; i < 3; ++i) {
      plane.axis[0][i] = k.phi_axis[i];
      plane.axis[1][i] = Real(i < 2 ? k.theta_axis[i] : 0.0);
      plane.up[i] = k.up[i];
      plane.omega[i] = plane.axis[1][i] * theta.rate + plane.axis[0][i] * phi.rate;
      plane.omega_dot[i] = k.phi_axis_slope[i] * both;
    }
    return plane;
  }

  // All terms except those of phi'' and theta''. `p` is the rolling velocity: the ball's velocity
  // minus the slip.
  template <class Real, class Ball>
  [[nodiscard]] Cause<Real> cause(const PlaneMotion<Real>& plane, const Ball& ball,
                                  const Real (&p)[2]) const {
    const auto& w = plane.omega;
    const double z = above();
    const Real squared = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    const Real along = w[0] * ball.x + w[1] * ball.y + z * w[2];
    Cause<Real> cause;
    for (int i = 0; i < 3; ++i) cause.omega_dot[i] = plane.omega_dot[i];
    cause.rest[0] = w[0] * along - squared * ball.x - 2.0 * (w[2] * ball.y_dot) + g * plane.up[0];
    cause.rest[1] = w[1] * along - squared * ball.y + 2.0 * (w[2] * ball.x_dot) + g * plane.up[1];
    cause.rest[2] = w[2] * along - squared * Real(z) +
                    2.0 * (w[0] * ball.y_dot - w[1] * ball.x_dot) + g * plane.up[2];
    // r omega = (-p_y, p_x, u)
    cause.turn[0] = w[1] * ball.u - w[2] * p[0];
    cause.turn[1] = -(w[2] * p[1]) - w[0] * ball.u;
    cause.turn[2] = w[0] * p[0] + w[1] * p[1];
    for (int i = 0; i < 2; ++i) cause.drag[i] = -(law.viscous * p[i]);
    return cause;
  }

  // The Cause of an acceleration of 1 rad/s^2 about one axis alone.
  template <class Real>
  [[nodiscard]] static Cause<Real> of_axis(const Real (&axis)[3]) {
    const Real none = Real(0.0);
    return {{axis[0], axis[1], axis[2]}, {none, none, none}, {none, none, none}, {none, none}};
  }

  // Equations (M37) to (M44).
  template <class Real, class Ball>
  [[nodiscard]] Answer<Real> answer(const ContactMode& mode, const Directions<Real>& along,
                                    const Ball& ball, const Cause<Real>& from) const {
    const auto& w = from.omega_dot;
    const double z = above(), k = rolling.k;
    const Real a_x = from.rest[0] + z * w[1] - ball.y * w[2];
    const Real a_y = from.rest[1] + ball.x * w[2] - z * w[0];
    const Real n = from.rest[2] + ball.y * w[0] - ball.x * w[1];
    const Real b_x = k * (r * w[0] + from.turn[0]), b_y = k * (r * w[1] + from.turn[1]);
    const Real b_n = r * w[2] + from.turn[2];
    Answer<Real> answer;
    Real(&f)[3] = answer.force;
    Real(&c)[3] = answer.couple;
    c[0] = from.drag[0] - law.rolling * (n * along.roll[0]);
    c[1] = from.drag[1] - law.rolling * (n * along.roll[1]);
    f[2] = n;
    if (mode.slides) {
      f[0] = -(law.sliding * (n * along.slip[0]));
      f[1] = -(law.sliding * (n * along.slip[1]));
      if (mode.rests) {
        c[0] = f[0] + b_y;
        c[1] = f[1] - b_x;
      }
      answer.x = f[0] - a_x;
      answer.y = f[1] - a_y;
      answer.slip[0] = answer.x - (1 / k) * (c[0] - f[0] - b_y);
      answer.slip[1] = answer.y - (1 / k) * (c[1] - f[1] + b_x);
    } else {
      if (mode.rests) {
        c[0] = b_y + a_x;
        c[1] = a_y - b_x;
        answer.x = answer.y = Real(0.0);
      } else {
        const double share = 1 / (1 + k);
        answer.x = share * (c[0] - b_y - a_x);
        answer.y = share * (c[1] + b_x - a_y);
      }
      answer.slip[0] = answer.slip[1] = Real(0.0);
      f[0] = answer.x + a_x;
      f[1] = answer.y + a_y;
    }
    if (mode.held) {
      answer.u = Real(0.0);
      c[2] = k * b_n;
    } else {
      c[2] = -((law.pivoting * mode.turns) * n);
      answer.u = (law.pivoting > 0 ? 1 / k : 0.0) * c[2] - b_n;
    }
    return answer;
  }

  // The power lost to couples and friction, W. Parts at rest lose none.
  template <class Real, class Ball>
  [[nodiscard]] Real lost_power(const ContactMode& mode, const Answer<Real>& of, const Ball& ball,
                                const Real (&p)[2], const Real (&slip)[2]) const {
    Real power = Real(0.0);
    if (mode.slides) power = of.force[0] * slip[0] + of.force[1] * slip[1];
    if (!mode.rests) power = power + of.couple[0] * p[0] + of.couple[1] * p[1];
    if (!mode.held) power = power + of.couple[2] * ball.u;
    return -(m * power);
  }

  // The moment for plate and ball about an axis, N m: the terms of (M45) linear in the Cause,
  // without ring and rotors. `from` is either the full Cause or that of one axis.
  template <class Real, class Ball>
  [[nodiscard]] Real moment(const Real (&axis)[3], const Cause<Real>& from, const Answer<Real>& of,
                            const Ball& ball) const {
    const double h = rolling.height;
    const auto& f = of.force;
    const Real x = m * (ball.y * f[2] - h * f[1] - r * of.couple[1]);
    const Real y = m * (h * f[0] - ball.x * f[2] + r * of.couple[0]);
    const Real z = m * (ball.x * f[1] - ball.y * f[0] + r * of.couple[2]);
    return axis[0] * (x + body.plate[0] * from.omega_dot[0]) +
           axis[1] * (y + body.plate[1] * from.omega_dot[1]) +
           axis[2] * (z + body.plate[2] * from.omega_dot[2]);
  }

  // The remaining terms of (M45) about an axis, N m: the plate's gyroscopic moment and its weight.
  template <class Real>
  [[nodiscard]] Real own_moment(const Real (&axis)[3], const PlaneMotion<Real>& plane) const {
    const auto& w = plane.omega;
    const double* const j = body.plate;
    const double weight = body.imbalance * g;
    return axis[0] * ((j[2] - j[1]) * (w[1] * w[2]) - weight * plane.up[1]) +
           axis[1] * ((j[0] - j[2]) * (w[2] * w[0]) + weight * plane.up[0]) +
           axis[2] * ((j[1] - j[0]) * (w[0] * w[1]));
  }
};

[[nodiscard]] CoupledBall coupled_ball(const Scenario& scene);

}  // namespace bbsim::model
