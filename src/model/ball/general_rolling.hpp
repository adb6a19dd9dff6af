// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ball's equation of motion for rigs other than the paper's: a plane above the gimbal's center,
// axes out of square or out of level, any moment of inertia (docs/explanation/model.md, "Other
// mountings and other balls").
#pragma once

#include "model/ball/rolling.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// The plane's kinematics for R = Ry(phi) Rz(skew) Rx(theta) Rz(yaw - skew) on a base tilted about
// its x axis, in the plane's frame: (M15) to (M17). phi_axis_slope is the derivative of phi_axis
// with respect to theta.
template <class Theta, class Both, class Number = double>
struct PlaneKinematics {
  Number theta_axis[2];  // z: 0
  Theta phi_axis[3], phi_axis_slope[3];
  Both up[3];
};

// Replaces Equation27 in a system. For the paper's rig it equals (27) up to rounding. Number: of
// the rig's constants.
template <class Number>
struct GeneralRollingOf {
  Number k = Number(0.4);       // kappa: the ball's moment of inertia over m r^2
  Number height = Number(0.0);  // of the contact plane above the gimbal's center, m
  Number cos_skew = Number(1.0), sin_skew = Number(0.0);
  Number cos_turn = Number(1.0), sin_turn = Number(0.0);  // of yaw - skew
  Number cos_base = Number(1.0), sin_base = Number(0.0);

  bool operator==(const GeneralRollingOf&) const = default;

  template <class Phi, class Theta>
  [[nodiscard]] auto kinematics(const Phi& phi, const Theta& theta) const {
    using T = std::decay_t<decltype(theta.cos)>;
    using B = std::decay_t<decltype(phi.cos * theta.cos)>;
    PlaneKinematics<T, B, Number> plane;
    plane.theta_axis[0] = cos_turn;
    plane.theta_axis[1] = -sin_turn;
    const T& c = theta.cos;
    const T& s = theta.sin;
    plane.phi_axis[0] = T(sin_skew * cos_turn) + (cos_skew * sin_turn) * c;
    plane.phi_axis[1] = T(-sin_skew * sin_turn) + (cos_skew * cos_turn) * c;
    plane.phi_axis[2] = -(cos_skew * s);
    plane.phi_axis_slope[0] = -((cos_skew * sin_turn) * s);
    plane.phi_axis_slope[1] = -((cos_skew * cos_turn) * s);
    plane.phi_axis_slope[2] = -(cos_skew * c);
    // Rotates the vertical from the base to the plane, one rotation at a time.
    const B x0 = B(-(cos_base * phi.sin)), y0 = B(sin_base), z = B(cos_base * phi.cos);
    const B x1 = cos_skew * x0 + sin_skew * y0, y1 = cos_skew * y0 - sin_skew * x0;
    const B y2 = y1 * B(c) + z * B(s);
    plane.up[0] = cos_turn * x1 + sin_turn * y2;
    plane.up[1] = cos_turn * y2 - sin_turn * x1;
    plane.up[2] = z * B(c) - y1 * B(s);
    return plane;
  }

  template <class Real>
  struct Rates {
    Real x, y, u;  // x'', y'' and u' = r gamma'', m/s^2
  };

  // Newton's and Euler's equations of the ball in the plane's frame, with the contact force
  // eliminated: (M18) to (M20). Arguments as in model/ball/rolling.hpp.
  template <class Real, class Phi, class Theta, class Ball>
  [[nodiscard]] Rates<Real> rates(const Phi& phi, const Theta& theta, const Ball& ball,
                                  const Number& r, const Number& g) const {
    const auto plane = kinematics(phi, theta);
    const Number a[3] = {plane.theta_axis[0], plane.theta_axis[1], Number(0.0)};
    using T = std::decay_t<decltype(plane.phi_axis[0] * phi.rate)>;
    T omega[3], omega_dot[3];
    const T both = T(phi.rate * theta.rate);
    for (int i = 0; i < 3; ++i) {
      omega[i] = a[i] * theta.rate + plane.phi_axis[i] * phi.rate;
      omega_dot[i] = a[i] * theta.acceleration + plane.phi_axis[i] * phi.acceleration +
                     plane.phi_axis_slope[i] * both;
    }
    const Number above = r + height;
    const T squared = omega[0] * omega[0] + omega[1] * omega[1] + omega[2] * omega[2];
    const Real along = omega[0] * ball.x + omega[1] * ball.y + above * omega[2];
    // A_x + g up_x and A_y + g up_y: the center's acceleration without x'' and y'', plus gravity.
    const Real x_rest = -(2 * (omega[2] * ball.y_dot)) + above * omega_dot[1] -
                        omega_dot[2] * ball.y + omega[0] * along - squared * ball.x +
                        g * plane.up[0];
    const Real y_rest = 2 * (omega[2] * ball.x_dot) + omega_dot[2] * ball.x - above * omega_dot[0] +
                        omega[1] * along - squared * ball.y + g * plane.up[1];
    const Number share = Number(1.0) / (Number(1.0) + k);
    Rates<Real> rates;
    rates.x =
        -(share * (k * (r * omega_dot[1] - omega[2] * ball.y_dot - omega[0] * ball.u) + x_rest));
    rates.y = share * (k * (r * omega_dot[0] + omega[1] * ball.u - omega[2] * ball.x_dot) - y_rest);
    rates.u = -(r * omega_dot[2] + omega[0] * ball.x_dot + omega[1] * ball.y_dot);
    return rates;
  }
};
using GeneralRolling = GeneralRollingOf<double>;

// Whether the rig is the paper's, to which equation (27) applies.
[[nodiscard]] bool is_the_papers(const Scenario& scene);

[[nodiscard]] GeneralRolling general_rolling(const Scenario& scene);

}  // namespace bbsim::model
