// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Simpler equations for the ball than (27), to measure what the full one buys.
//
// Each is a policy for the systems of model/systems/system.hpp in the place of Equation27. In both
// the spin stays as it is.
#pragma once

#include "model/ball/rolling.hpp"

namespace bbsim::model {

// A ball rolling down the slope of the moment, as if the plane stood still.
struct SlopeOnly {
  template <class Real, class Phi, class Theta, class Ball>
  static Real x(const Phi& phi, const Theta&, const Ball&, double, double g) {
    return 5 * g * phi.sin / 7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real y(const Phi& phi, const Theta& theta, const Ball&, double, double g) {
    return -(5 * g * phi.cos * theta.sin) / 7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real u(const Phi&, const Theta&, const Ball&, double) {
    return Real(0.0);
  }
};

// The ball and plate of control textbooks: slope and centrifugal terms, but neither the rolling
// inertia that a turning plane sees, nor the spin, nor the accelerations of the gimbal.
struct BallAndPlate {
  template <class Real, class Phi, class Theta, class Ball>
  static Real x(const Phi& phi, const Theta& theta, const Ball& ball, double, double g) {
    return 5 * (g * phi.sin + ball.x * (phi.rate * phi.rate) + ball.y * (phi.rate * theta.rate)) /
           7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real y(const Phi& phi, const Theta& theta, const Ball& ball, double, double g) {
    return 5 *
           (ball.y * (theta.rate * theta.rate) + ball.x * (phi.rate * theta.rate) - g * theta.sin) /
           7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real u(const Phi&, const Theta&, const Ball&, double) {
    return Real(0.0);
  }
};

}  // namespace bbsim::model
