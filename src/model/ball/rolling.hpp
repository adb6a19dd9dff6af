// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Equation (27): a ball that rolls without slipping on a plane with a two-axis gimbal.
//
// Symbols as in docs/explanation/model.md. The spin enters as the speed u = r gamma', which has the
// size of x' and y'. gamma' itself grows as 1/r and would spoil the scaling for small balls.
#pragma once

#include "base/real.hpp"
#include "model/ball/zero_and_one.hpp"

namespace bbsim::model {

// A gimbal angle (rad): its sine and cosine, its rate (rad/s) and acceleration (rad/s^2).
template <class Real>
struct GimbalAngle {
  Real sin, cos, rate, acceleration;
};

// An angle that is zero at all times.
struct LockedAngle {
  Zero sin;
  One cos;
  Zero rate, acceleration;
};

// The ball in the plane's frame: contact point (m), its velocity (m/s), u = r gamma' (m/s).
template <class X, class Y, class U>
struct RollingState {
  X x;
  Y y;
  X x_dot;
  Y y_dot;
  U u;
};

// The three rows of equation (27), solved for x'', y'' and u' = r gamma'' (m/s^2). A parameter of
// the systems (systems/system.hpp), which study/verify.cpp replaces by simpler equations.
//
// r is the ball's radius (m) and g gravity (m/s^2). Scalar is double, or a pack with one ball per
// lane. Real is the type of the result: double, a dual number, a pack of lanes, or a 128-bit float.
// The other arguments may have any types that combine to Real, including Zero and One.
struct Equation27 {
  template <class Real, class Phi, class Theta, class Ball, class Scalar>
  [[nodiscard]] static Real x(const Phi& phi, const Theta& theta, const Ball& ball, const Scalar& r,
                              const Scalar& g) {
    return (5 * g * phi.sin                                                             //
            - (7 * r * theta.cos + 5 * ball.y * theta.sin) * phi.acceleration           //
            + 5 * ball.x * (phi.rate * phi.rate)                                        //
            - (10 * ball.y * theta.cos - 12 * r * theta.sin) * (phi.rate * theta.rate)  //
            - 12 * theta.sin * phi.rate * ball.y_dot + 2 * theta.rate * ball.u) /
           7;
  }

  template <class Real, class Phi, class Theta, class Ball, class Scalar>
  [[nodiscard]] static Real y(const Phi& phi, const Theta& theta, const Ball& ball, const Scalar& r,
                              const Scalar& g) {
    return (5 * ball.x * theta.sin * phi.acceleration + 7 * r * theta.acceleration          //
            + 5 * (ball.y * theta.sin + r * theta.cos) * theta.sin * (phi.rate * phi.rate)  //
            + 5 * ball.y * (theta.rate * theta.rate)                                        //
            + 12 * theta.sin * phi.rate * ball.x_dot + 2 * theta.cos * phi.rate * ball.u    //
            - 5 * g * phi.cos * theta.sin) /
           7;
  }

  template <class Real, class Phi, class Theta, class Ball, class Scalar>
  [[nodiscard]] static Real u(const Phi& phi, const Theta& theta, const Ball& ball,
                              const Scalar& r) {
    return r * (theta.sin * phi.acceleration + theta.cos * (phi.rate * theta.rate))  //
           - (theta.rate * ball.x_dot + theta.cos * phi.rate * ball.y_dot);
  }
};

}  // namespace bbsim::model
