// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// configs/rig.yaml as one would write it by hand, for that one rig, with a library of one's own
// choice: what bbsim's rigs are measured against.
//
// The same sensor, controller, delays and commands, without events and limits as such: angles and
// rates are clamped, and whether the ball is on the plate is looked at once a piece. Numbers stand
// in the code, the equations are written out, nothing is virtual or allocated.
#pragma once

#include <cstddef>

namespace bbsim::bench {

struct HandRow {
  double x, y, phi, theta, phi_command, theta_command;
};

struct HandRun {
  bool noise = true;  // of the sensor, bbsim's own generator
  // Of odeint's Dormand-Prince 5(4); 0: classical Runge-Kutta with two steps from instant to
  // instant.
  double rtol = 1e-8;
};

inline constexpr std::size_t hand_rows = 2001;

// Fills all rows; false if the ball left the plate.
bool run_by_hand(const HandRun& run, HandRow* rows);

}  // namespace bbsim::bench
