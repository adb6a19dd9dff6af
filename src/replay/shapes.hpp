// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The few solids that the rig is made of, as triangles.
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

// Diameter 1 about the z axis, from z = -1/2 to 1/2.
[[nodiscard]] Mesh unit_cylinder();

// About the z axis: a tube whose middle has radius 1.
[[nodiscard]] Mesh ring(float tube_radius);

// Every other octant of the unit sphere: with the others in another colour it is the engineer's
// mark of a centre of mass, on which every rotation is seen.
[[nodiscard]] Mesh octants(bool odd);

}  // namespace bbsim::replay
