// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene as binary glTF 2.0 (.glb), for Blender and slides.
#pragma once

#include <string>

#include "replay/scene.hpp"

namespace bbsim::replay {

// Nodes as the gimbal is built: base, ring (phi), hinge (theta), plate, ball, one such chain a run;
// a run without angles has its ball on the first one's plate. One animation moves ring and hinge
// (rotations) and ball (translation and rotation), from the first run's start on, interpolated
// linearly between the rows that kept_rows() says. The path is a line on the plate. glTF has the y
// axis up and metres; the root turns z up. Throws InputError for a scene without a run or that
// cannot be shown (check_scene()).
[[nodiscard]] std::string gltf(const Scene& scene);

// Whole or not at all; "-" is standard output.
void write_gltf(const std::string& file, const Scene& scene);

}  // namespace bbsim::replay
