// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Simpler equations of motion than (27), to measure what the full equation adds.
//
// Each is a policy for the systems of model/systems/system.hpp and replaces Equation27. In both,
// the spin stays constant.
#pragma once

#include "model/ball/rolling.hpp"

namespace bbsim::model {

// The ball rolls down the current slope as if the plane stood still.
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

// The textbook ball and plate: slope and centrifugal terms, without the effect of the plane's
// rotation on the rolling inertia, without the spin, and without the gimbal's accelerations.
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
