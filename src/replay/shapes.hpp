// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The solids of the rig, as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace bbsim::replay {

struct Mesh {
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::uint16_t> triangles;  // three corners each, counterclockwise from outside
};

// A box from -1/2 to 1/2 along each axis.
[[nodiscard]] Mesh unit_box();

// A cylinder of diameter 1 about the z axis, from z = -1/2 to 1/2.
[[nodiscard]] Mesh unit_cylinder();

// A torus about the z axis; the center line of its tube has radius 1.
[[nodiscard]] Mesh ring(float tube_radius);

// Every other octant of the unit sphere. In two colors, octants are the engineer's mark of a center
// of mass and show every rotation.
[[nodiscard]] Mesh octants(bool odd);

}  // namespace bbsim::replay
