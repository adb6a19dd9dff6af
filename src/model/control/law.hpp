// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The control law: what a controller commands at a state, for every number type.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/real.hpp"
#include "model/signals/spline.hpp"

namespace bbsim::model {

// Proportional and derivative gains, rows phi, theta; columns x, y: equation (31). Scalar is that
// of rolling.hpp: a pack of doubles holds one loop per lane.
template <class Scalar>
struct BasicGains {
  Scalar kv[2][2], kp[2][2];
};
using Gains = BasicGains<double>;

// Equation (31) for one row of the gains; `ball` is a RollingState.
template <class Real, class Scalar, class Ball, class Time>
[[nodiscard]] Real command(const BasicGains<Scalar>& law, std::size_t row, const Ball& ball,
                           const std::array<Jet<Time>, 2>& reference) {
  return law.kv[row][0] * (reference[0].rate - ball.x_dot) +
         law.kv[row][1] * (reference[1].rate - ball.y_dot) +
         law.kp[row][0] * (reference[0].value - ball.x) +
         law.kp[row][1] * (reference[1].value - ball.y);
}

enum class LawKind { held, played, linear, gravity_compensation, feedback_linearisation };

// Whether commands depend on the state.
[[nodiscard]] constexpr bool feeds_back(LawKind kind) {
  return kind != LawKind::held && kind != LawKind::played;
}

// How a command u follows from the error e = reference - (x, y), rows phi, theta.
//   held                    no law: the command stays
//   played                  no law: the command is the reference, a known function of time
//   linear                  u = gain (e, e', -q, -q') + i, i' = integral e; q: the servos' angles
//   gravity_compensation    angles at which gravity gives the ball x_d'' + kv e' + kp e
//   feedback_linearisation  accelerations of the gimbal that give the ball the same
template <class Scalar>
struct BasicControlLaw {
  LawKind kind = LawKind::held;
  Scalar gain[2][8] = {};
  Scalar integral[2][2] = {};
  Scalar kv[2][2] = {}, kp[2][2] = {};
  Scalar scale = {};  // (1 + k) / g, s^2/m, for gravity compensation

  [[nodiscard]] bool feeds_servos_back() const {
    for (const auto& row : gain) {
      for (int j = 4; j < 8; ++j) {
        if (row[j] != 0) return true;
      }
    }
    return false;
  }

  // Whether command i has an integral part; whether any has.
  [[nodiscard]] bool integrates(std::size_t i) const {
    return integral[i][0] != 0 || integral[i][1] != 0;
  }
  [[nodiscard]] bool integrates() const { return integrates(0) || integrates(1); }
};
using ControlLaw = BasicControlLaw<double>;

// Calls use(to, from) for each number of two laws, which may differ in type. Lanes and derivatives
// by keys take all numbers from here.
template <class To, class From, class Use>
void for_each_number(To& to, From& from, const Use& use) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 8; ++j) use(to.gain[i][j], from.gain[i][j]);
    for (std::size_t j = 0; j < 2; ++j) {
      use(to.integral[i][j], from.integral[i][j]);
      use(to.kv[i][j], from.kv[i][j]);
      use(to.kp[i][j], from.kp[i][j]);
    }
  }
  use(to.scale, from.scale);
}

// Signals that a law feeds back, SI. Integral is Zero if nothing is integrated.
template <class Real, class Integral = Real>
struct Feedback {
  Real position[2], velocity[2];  // of the ball, as the controller knows them
  Real angle[2], rate[2];         // of the servos
  Integral integral[2];           // integral part of each command
};

template <class Real>
struct Command {
  Real raw[2];    // before the limit; sine of the angle in gravity compensation
  Real value[2];  // after the limit, rad, or rad/s^2 if accelerations are driven
};

[[nodiscard]] inline double arcsine(double s) {
  return std::asin(s);
}

// asin(s) for |s| below 0.99 with derivatives, for any other number type. Newton's method.
template <class Real>
[[nodiscard]] Real arcsine(const Real& s) {
  const Real s2 = s * s;
  Real angle = s * (Real(1.0) + s2 * (Real(1.0 / 6) + s2 * (Real(3.0 / 40) + (15.0 / 336) * s2)));
  // Six iterations suffice up to |s| = 0.99.
  for (int i = 0; i < 6; ++i) {
    const SinCos<Real> at = sin_cos(angle);
    angle = angle - (at.sin - s) / at.cos;
  }
  return angle;
}

// Growth of the integral part of command i without a limit: K_I e, in the command's unit per
// second.
template <class Scalar, class Real, class Time>
[[nodiscard]] Real integral_rate(const BasicControlLaw<Scalar>& law, std::size_t i,
                                 const Real* position, const std::array<Jet<Time>, 2>& reference) {
  return law.integral[i][0] * (reference[0].value - position[0]) +
         law.integral[i][1] * (reference[1].value - position[1]);
}

// The acceleration of the ball that the last two laws ask for in coordinate i, m/s^2.
template <class Scalar, class Real, class Integral, class Time>
[[nodiscard]] Real wanted_acceleration(const BasicControlLaw<Scalar>& law, std::size_t i,
                                       const Feedback<Real, Integral>& state,
                                       const std::array<Jet<Time>, 2>& reference) {
  Real wanted = Real(reference[i].acceleration);
  for (std::size_t j = 0; j < 2; ++j) {
    wanted = wanted + law.kv[i][j] * (reference[j].rate - state.velocity[j]) +
             law.kp[i][j] * (reference[j].value - state.position[j]);
  }
  return wanted;
}

// `limited(i, raw)` limits a command, or a sine in gravity compensation. Not for feedback
// linearization, which needs the plant's equations, nor for a held command.
template <class Scalar, class Real, class Integral, class Time, class Limited>
[[nodiscard]] Command<Real> command(const BasicControlLaw<Scalar>& law,
                                    const Feedback<Real, Integral>& state,
                                    const std::array<Jet<Time>, 2>& reference,
                                    const Limited& limited) {
  Command<Real> u;
  if (law.kind == LawKind::played) {
    for (std::size_t i = 0; i < 2; ++i) {
      u.raw[i] = Real(reference[i].value);
      u.value[i] = limited(static_cast<int>(i), u.raw[i]);
    }
    return u;
  }
  if (law.kind == LawKind::gravity_compensation) {
    // The static part of (27): (1 + k) x'' = g sin phi, (1 + k) y'' = -g cos phi sin theta.
    u.raw[0] = law.scale * wanted_acceleration(law, 0, state, reference);
    u.value[0] = arcsine(limited(0, u.raw[0]));
    u.raw[1] =
        -(law.scale * wanted_acceleration(law, 1, state, reference)) / sin_cos(u.value[0]).cos;
    u.value[1] = arcsine(limited(1, u.raw[1]));
    return u;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Real sum = Real(0.0);
    for (std::size_t j = 0; j < 2; ++j) {
      sum = sum + (law.gain[i][j] * (reference[j].value - state.position[j]) +
                   law.gain[i][2 + j] * (reference[j].rate - state.velocity[j]) -
                   law.gain[i][4 + j] * state.angle[j] - law.gain[i][6 + j] * state.rate[j]);
    }
    sum = sum + state.integral[i];
    u.raw[i] = sum;
    u.value[i] = limited(static_cast<int>(i), sum);
  }
  return u;
}

// Conditional integration at a limit (docs/explanation/rig-model.md, (M64) and (M65)): how a
// command evolves if its integral part waits while the command is at its limit and the error drives
// it outward.
//
// Position of a limited quantity u = w + q; q is its integral part.
enum class AtLimit {
  within,  // u is free, and so is q
  beyond,  // u is cut off; q waits, or moves inward with the error
  along    // u stays at the limit and q moves accordingly: Filippov's sliding mode
};

// Rates of such a quantity, positive outward, in its unit per second.
struct OutwardRate {
  double waiting = 0;  // while q waits: w' minus the rate of the limit
  double push = 0;     // added by the error while q integrates: K_I e

  // Just within the limit q integrates; just beyond it, only inward.
  [[nodiscard]] double within() const { return waiting + push; }
  [[nodiscard]] double beyond() const { return waiting + std::min(push, 0.0); }
  // If both limits are equal, the rate on their other side, where q also integrates only inward.
  [[nodiscard]] double beyond_other() const { return waiting + std::max(push, 0.0); }

  // How a quantity continues from exactly its limit; `inner`: within(), or beyond_other().
  [[nodiscard]] AtLimit at_limit(double inner) const {
    if (!(inner > 0)) return AtLimit::within;
    return beyond() < 0 ? AtLimit::along : AtLimit::beyond;
  }
  [[nodiscard]] AtLimit at_limit() const { return at_limit(within()); }
};

}  // namespace bbsim::model
