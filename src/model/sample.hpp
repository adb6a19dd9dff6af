// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One instant of a run in the symbols of the paper: what the columns are computed from.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "base/real.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// The ball in the plane's own frame, SI units. gamma_dot is the spin.
struct BallMotion {
  double x = 0, y = 0, x_dot = 0, y_dot = 0, gamma_dot = 0;
};

// The gimbal's angles and their derivatives, rad, rad/s, rad/s^2.
struct GimbalState {
  double phi = 0, theta = 0;
  double phi_dot = 0, theta_dot = 0;
  double phi_ddot = 0, theta_ddot = 0;
};

// How much of a sample is wanted: the ball alone; with the gimbal's angles and rates; with its
// accelerations; with commands and what was measured; or all, and so the reference too. The rest is
// left as it is without a value.
enum class Detail { ball, gimbal, motion, loop, all };

// What a scene with couples, sliding or torques has beside that. All of them doubles.
struct CoupledMotion {
  double x_ddot, y_ddot;       // m/s^2
  double couple[3];            // of the plane on the ball, in the plane's frame, N m
  double slip[2];              // velocity of the ball's surface at the contact, m/s
  double asked[2];             // of the motors: torque before their limits, N m
  double given[2];             // and behind them
  double lost_power;           // to couples and friction, W
  double lost, work;           // energy lost, and given by the motors, since the start, J
  double sliding = no_number;  // the coefficient of friction, of a ball that slides

  static constexpr int size = 15;
};
static_assert(sizeof(CoupledMotion) == CoupledMotion::size * sizeof(double));

struct Sample {
  double t = 0;  // s
  BallMotion ball{};
  double gamma = 0;  // rad, 0 at the start and by symmetry; no number if not integrated
  GimbalState gimbal{};
  Pair reference{0, 0};  // m; (0, 0) in open loop
  Pair command{0, 0};    // what the gimbal is told, rad or rad/s^2; (0, 0) in open loop
  Pair measured{0, 0};   // where the controller last saw the ball, m
  // Of the servos, rad: phi's and theta's, or three; 0 where there are none.
  std::array<double, 3> servo{0, 0, 0};
  Pair push{0, 0};  // on the ball's centre, along the plane's axes, N
  // How far what is between the servos and the plane is from where it ends; negative beyond.
  double to_dead_point = std::numeric_limits<double>::infinity();
  std::optional<CoupledMotion> coupled{};
  // What one's own controller gave beside its last command, in the order of
  // SampledLoop::own_columns; stands in the row, and is null where there is none.
  const double* own = nullptr;
};

}  // namespace bbsim::model
