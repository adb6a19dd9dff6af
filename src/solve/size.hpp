// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sizes of a motion whose greatest value over a run lanes find. They are smooth: squares instead of
// roots.
#pragma once

namespace bbsim::solve {

enum Size : int {
  versine,           // 1 - cos(tilt) of the plate
  rate_squared,      // of the plate's angular velocity, (rad/s)^2
  distance_squared,  // of the contact point from the plate's origin, m^2
  error_squared,     // of the contact point from the reference, m^2
  size_count
};

}  // namespace bbsim::solve
