// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// configs/rig.yaml written by hand for this one rig, with odeint, for comparison with bbsim's rigs.
//
// Sensor, controller, delays and commands are the same, but there are no events or limits as in
// bbsim. Angles and rates are clamped, and the edge of the plate is checked once per piece. Numbers
// are constants, the equations are written out, and nothing is virtual or allocated.
#pragma once

#include <cstddef>

namespace bbsim::bench {

struct HandRow {
  double x, y, phi, theta, phi_command, theta_command;
};

struct HandRun {
  bool noise = true;  // sensor noise, from bbsim's generator
  // For odeint's Dormand-Prince 5(4). 0: classical Runge-Kutta with two steps between instants.
  double rtol = 1e-8;
};

inline constexpr std::size_t hand_rows = 2001;

// Fills all rows. Returns false if the ball left the plate.
bool run_by_hand(const HandRun& run, HandRow* rows);

}  // namespace bbsim::bench
