// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An instant of a run in the paper's symbols, from which the columns are computed.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/real.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// The ball in the plane's frame, SI units. gamma_dot is the spin.
struct BallMotion {
  double x = 0, y = 0, x_dot = 0, y_dot = 0, gamma_dot = 0;
};

// The gimbal's angles and their derivatives, rad, rad/s, rad/s^2.
struct GimbalState {
  double phi = 0, theta = 0;
  double phi_dot = 0, theta_dot = 0;
  double phi_ddot = 0, theta_ddot = 0;
};

// Parts of a sample to fill; each includes those before it: the ball; the gimbal's angles and
// rates; its accelerations; commands and measurements; the reference. `path` is the ball and the
// reference only. Other parts may stay unset.
enum class Detail { ball, path, gimbal, motion, loop, all };

// The additional quantities of a coupled scene. All are doubles.
struct CoupledMotion {
  double x_ddot, y_ddot;       // m/s^2
  double couple[3];            // of the plane on the ball, in the plane's frame, N m
  double slip[2];              // velocity of the ball's surface at the contact, m/s
  double asked[2];             // motor torques before their limits, N m
  double given[2];             // motor torques within their limits, N m
  double lost_power;           // to couples and friction, W
  double lost, work;           // energy lost, and work of the motors, since the start, J
  double sliding = no_number;  // coefficient of sliding friction while the ball slides

  static constexpr int size = 15;
};
static_assert(sizeof(CoupledMotion) == CoupledMotion::size * sizeof(double));

struct Sample {
  double t = 0;  // s
  BallMotion ball{};
  double gamma = 0;  // rad, 0 at the start and by symmetry; NaN if not integrated
  GimbalState gimbal{};
  Pair reference{0, 0};  // m; (0, 0) in open loop
  Pair command{0, 0};    // to the gimbal, in the command's unit; (0, 0) in open loop
  Pair measured{0, 0};   // the controller's last measurement of the ball, m
  // Servo angles, rad: of phi and theta, or of three servos; 0 without servos.
  std::array<double, 3> servo{0, 0, 0};
  std::array<double, 3> counted{0, 0, 0};  // of steppers: what their drivers have counted, rad
  Pair push{0, 0};                         // on the ball's center, along the plane's axes, N
  // Distance of the linkage from the end of its range; negative beyond it.
  double to_dead_point = std::numeric_limits<double>::infinity();
  std::optional<CoupledMotion> coupled{};
  // Numbers that an external controller returned with its last command, in the order of
  // SampledLoop::own_columns. Points into the row; null without such numbers.
  const double* own = nullptr;
};

// An event that occurred.
struct Occurrence {
  double t = 0;               // s
  std::string name;           // the key in the scenario's events
  bool stopped = false;       // whether it stopped the run
  Sample sample;              // without Sample::own; see `own`
  std::vector<double> own{};  // numbers of an external controller
};

}  // namespace bbsim::model
