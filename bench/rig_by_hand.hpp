// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// configs/rig.yaml written by hand for this one rig, with odeint: the program that bbsim's rigs are
// compared with.
//
// It has the same sensor, controller, delays and commands, but no events and no limits of bbsim's
// kind. Angles and rates are clamped, and the edge of the plate is checked once a piece. Numbers
// are constants, the equations are written out, nothing is virtual or allocated.
#pragma once

#include <cstddef>

namespace bbsim::bench {

struct HandRow {
  double x, y, phi, theta, phi_command, theta_command;
};

struct HandRun {
  bool noise = true;  // of the sensor, by bbsim's generator
  // Of odeint's Dormand-Prince 5(4). 0: classical Runge-Kutta with two steps between instants.
  double rtol = 1e-8;
};

inline constexpr std::size_t hand_rows = 2001;

// Fills all rows; false if the ball left the plate.
bool run_by_hand(const HandRun& run, HandRow* rows);

}  // namespace bbsim::bench
