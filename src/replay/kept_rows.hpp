// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which rows of a long run a picture needs.
#pragma once

#include <cstddef>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::replay {

struct KeptRows {
  std::vector<std::size_t> rows;  // increasing; the first and the last are always there
  std::size_t buckets = 0;        // of the plots; 0 if all rows are kept
  // How far straight lines between kept rows are from the rows left out, at worst, in units of the
  // tolerances below; 0 if all rows are kept. Beyond 1 only where `most` did not suffice.
  double motion_error = 0;
};

// What the motion between two kept rows may be off by, interpolated: far below a pixel.
inline constexpr double position_tolerance = 1.0 / 2000;  // of the largest distance from home
inline constexpr double angle_tolerance = 2e-4;           // of the gimbal, rad
inline constexpr double orientation_tolerance = 0.05;     // of the ball, rad
inline constexpr double largest_turn = 2.0;               // of the ball from row to row, rad

// All rows, if there are at most `most`. Otherwise half of `most` goes to the plots: the run is cut
// into as many buckets of equal numbers of rows as that allows, and in each the first row and the
// least and the greatest value of every column are kept, so that no peak is lost. The other half
// goes to the motion: the stretch that interpolation is furthest off in is halved at its worst row,
// until all is within the tolerances or the half is used up.
[[nodiscard]] KeptRows kept_rows(const Run& run, const std::vector<Quaternion>& orientation,
                                 std::size_t most);

}  // namespace bbsim::replay
