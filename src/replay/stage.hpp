// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sizes of the plate and the ball in a picture, given by the scene or fitted to the paths.
#pragma once

#include "replay/scene.hpp"

namespace bbsim::replay {

// The page draws with floats, which cannot hold the square of a larger distance.
inline constexpr double largest_drawn = 1e15;  // m

struct Stage {
  double width = 0, depth = 0;  // of the plate along x and y, m
  bool round = false;
  bool plate_given = false;  // otherwise it fits the paths
  double ball_radius = 0;    // of the leading run, m
  bool ball_given = false;   // otherwise a thirtieth of the plate
};

// The stage for all runs of the scene. The first run with a plate defines the plate. Otherwise the
// plate fits all paths and references that are drawn; if these stay on an axis, it is a beam.
[[nodiscard]] Stage stage_of(const Scene& scene);

}  // namespace bbsim::replay
