// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rotations as unit quaternions.
#pragma once

#include <array>

namespace bbsim {

// (w, x, y, z).
using Quaternion = std::array<double, 4>;

// The rotation about `vector` by an angle equal to its length (rad).
[[nodiscard]] Quaternion rotation_by(const std::array<double, 3>& vector);

// The rotation b followed by the rotation a.
[[nodiscard]] Quaternion product(const Quaternion& a, const Quaternion& b);

// q scaled to norm 1. q must not be 0.
[[nodiscard]] Quaternion normalised(const Quaternion& q);

}  // namespace bbsim
