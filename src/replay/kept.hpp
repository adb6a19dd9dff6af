// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Selects what a page keeps of long runs and of large sweeps.
#pragma once

#include <cstddef>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::replay {

struct KeptRows {
  std::vector<std::size_t> rows;  // increasing; include the first and the last row
  std::size_t buckets = 0;        // of the plots; 0 if all rows are kept
  // The greatest error of interpolation at a row left out, in units of the tolerances below; 0 if
  // all rows are kept. It exceeds 1 only if `most` did not suffice.
  double motion_error = 0;
};

// Tolerances for the interpolated motion between kept rows: far below a pixel.
inline constexpr double position_tolerance = 1.0 / 2000;  // of the largest distance from home
inline constexpr double angle_tolerance = 2e-4;           // of the gimbal, rad
inline constexpr double orientation_tolerance = 0.05;     // of the ball, rad

// Returns all rows if there are at most `most`. Otherwise, half of `most` goes to the plots. The
// run is cut into as many buckets with equal numbers of rows as fit. Each bucket keeps its first
// and last rows and the least and greatest value of every column, so no peak is lost. The other
// half goes to the motion. The stretch with the worst interpolation is split at its worst row,
// until all errors are within the tolerances or the half is used up.
[[nodiscard]] KeptRows kept_rows(const Run& run, const std::vector<Quaternion>& orientation,
                                 std::size_t most);

// Returns all cases if there are at most `most`. A grid has every combination of its keys' values
// once. It keeps every 2nd, 4th, 8th, ... value of the keys with the most values, so that the rest
// is a grid with the same first values. Other sweeps keep every n-th case.
[[nodiscard]] std::vector<std::size_t> cases_kept(const Sweep& sweep, std::size_t most);

}  // namespace bbsim::replay
