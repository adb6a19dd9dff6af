// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/shapes.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace bbsim::replay {
namespace {

using Point = std::array<float, 3>;

Point point(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

std::uint16_t add(Mesh& mesh, const Point& position, const Point& normal) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  return static_cast<std::uint16_t>(mesh.positions.size() - 1);
}

void add_quad(Mesh& mesh, std::uint16_t a, std::uint16_t b, std::uint16_t c, std::uint16_t d) {
  for (const std::uint16_t corner : {a, b, c, a, c, d}) mesh.triangles.push_back(corner);
}

// Adds a grid of rows x columns vertices, which place(row, column) adds. Faces point to the left of
// the direction along the rows.
template <class Place>
void add_grid(Mesh& mesh, std::size_t rows, std::size_t columns, Place place) {
  const std::size_t first = mesh.positions.size();
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) place(i, j);
  }
  const auto at = [&](std::size_t i, std::size_t j) {
    return static_cast<std::uint16_t>(first + i * columns + j);
  };
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    for (std::size_t j = 0; j + 1 < columns; ++j) {
      add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  }
}

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

Mesh unit_box() {
  Mesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      Point normal{};
      normal[axis] = side;
      const auto corner = [&](float u, float v) {
        Point position{};
        position[axis] = side / 2;
        position[(axis + 1) % 3] = u * side / 2;  // mirrored, to stay counterclockwise
        position[(axis + 2) % 3] = v / 2;
        return add(mesh, position, normal);
      };
      const std::uint16_t a = corner(-1, -1), b = corner(1, -1), c = corner(1, 1),
                          d = corner(-1, 1);
      add_quad(mesh, a, b, c, d);
    }
  }
  return mesh;
}

Mesh unit_cylinder() {
  constexpr std::size_t corners = 64;
  Mesh mesh;
  const auto angle = [](std::size_t j) { return turn * static_cast<double>(j) / corners; };
  add_grid(mesh, 2, corners + 1, [&](std::size_t i, std::size_t j) {
    const double c = std::cos(angle(j)), s = std::sin(angle(j));
    add(mesh, point(c / 2, s / 2, i == 0 ? -0.5 : 0.5), point(c, s, 0));
  });
  for (const double side : {-1.0, 1.0}) {
    const std::uint16_t centre = add(mesh, point(0, 0, side / 2), point(0, 0, side));
    for (std::size_t j = 0; j <= corners; ++j) {
      add(mesh, point(std::cos(angle(j)) / 2, side * std::sin(angle(j)) / 2, side / 2),
          point(0, 0, side));
      if (j == 0) continue;
      const auto last = static_cast<std::uint16_t>(mesh.positions.size() - 1);
      for (const std::uint16_t corner : {centre, static_cast<std::uint16_t>(last - 1), last}) {
        mesh.triangles.push_back(corner);
      }
    }
  }
  return mesh;
}

Mesh ring(float tube_radius) {
  constexpr std::size_t around = 96, across = 12;
  Mesh mesh;
  add_grid(mesh, across + 1, around + 1, [&](std::size_t i, std::size_t j) {
    const double tube = turn * static_cast<double>(i) / across;
    const double angle = turn * static_cast<double>(j) / around;
    const double c = std::cos(angle), s = std::sin(angle);
    const double out = 1 + static_cast<double>(tube_radius) * std::cos(tube);
    add(mesh, point(out * c, out * s, static_cast<double>(tube_radius) * std::sin(tube)),
        point(std::cos(tube) * c, std::cos(tube) * s, std::sin(tube)));
  });
  return mesh;
}

Mesh octants(bool odd) {
  constexpr std::size_t steps = 8;  // of an octant, along each edge
  constexpr double quarter = turn / 4;
  Mesh mesh;
  for (std::size_t sector = 0; sector < 4; ++sector) {
    for (std::size_t half = 0; half < 2; ++half) {
      if (((sector + half) % 2 == 1) != odd) continue;
      add_grid(mesh, steps + 1, steps + 1, [&](std::size_t i, std::size_t j) {
        const double latitude =
            quarter * (static_cast<double>(half + 0) - 1 + static_cast<double>(i) / steps);
        const double longitude =
            quarter * (static_cast<double>(sector) + static_cast<double>(j) / steps);
        const Point p = point(std::cos(latitude) * std::cos(longitude),
                              std::cos(latitude) * std::sin(longitude), std::sin(latitude));
        add(mesh, p, p);
      });
    }
  }
  return mesh;
}

}  // namespace bbsim::replay
