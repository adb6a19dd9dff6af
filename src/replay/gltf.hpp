// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a scene as binary glTF 2.0 (.glb), for Blender and slides.
#pragma once

#include <string>

#include "replay/scene.hpp"

namespace bbsim::replay {

// The nodes follow the gimbal: base, ring (phi), hinge (theta), plate, ball, with one chain for
// each run. A run without angles has its ball on the plate of the first run. One animation moves
// the ring and the hinge (rotations) and the ball (translation and rotation). It starts at the
// earliest time of all runs and interpolates linearly between the rows of kept_rows(). The path is
// a line on the plate. Units are meters; glTF has the y axis up, so the root turns z up. Throws
// InputError for a scene without a run, and as check_scene() does.
[[nodiscard]] std::string gltf(const Scene& scene);

// Writes the file whole or not at all; "-" is standard output.
void write_gltf(const std::string& file, const Scene& scene);

}  // namespace bbsim::replay
