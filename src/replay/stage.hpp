// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sizes of what is drawn around the ball: as the scene gives them, or such that the path fits.
#pragma once

#include "replay/scene.hpp"

namespace bbsim::replay {

// What is further away is not drawn: a float, of which pictures are made, holds its square no more.
inline constexpr double largest_drawn = 1e15;  // m

struct Stage {
  double width = 0, depth = 0;  // of the plate along x and y, m
  bool round = false;
  bool plate_given = false;  // else it is drawn to fit the paths
  double ball_radius = 0;    // of the leading run
  bool ball_given = false;   // else it is a thirtieth of the plate
};

// The stage for all runs of the scene; the first run that has a plate says what the plate is. One
// that is drawn to fit holds all paths and references, as far as they are drawn at all; where these
// stay on an axis it is a beam.
[[nodiscard]] Stage stage_of(const Scene& scene);

}  // namespace bbsim::replay
