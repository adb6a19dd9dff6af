// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rotations as unit quaternions.
#pragma once

#include <array>
#include <cmath>

namespace bbsim {

// (w, x, y, z).
using Quaternion = std::array<double, 4>;

// The rotation about `vector` by an angle equal to its length (rad).
[[nodiscard]] inline Quaternion rotation_by(const std::array<double, 3>& vector) {
  const double angle = std::hypot(vector[0], vector[1], vector[2]);
  // sin(angle/2) / angle tends to 1/2 as the angle tends to 0.
  const double scale = angle < 1e-8 ? 0.5 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), scale * vector[0], scale * vector[1], scale * vector[2]};
}

// The rotation b followed by the rotation a.
[[nodiscard]] inline Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

// q scaled to norm 1. q must not be 0.
[[nodiscard]] inline Quaternion normalised(const Quaternion& q) {
  const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  return {q[0] / size, q[1] / size, q[2] / size, q[3] / size};
}

}  // namespace bbsim
