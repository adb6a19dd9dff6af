// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rotations as unit quaternions.
#pragma once

#include <array>

namespace bbsim {

// w, x, y, z.
using Quaternion = std::array<double, 4>;

// The rotation by the length of `vector` about it.
[[nodiscard]] Quaternion rotation_by(const std::array<double, 3>& vector);

// First b, then a.
[[nodiscard]] Quaternion product(const Quaternion& a, const Quaternion& b);

[[nodiscard]] Quaternion conjugate(const Quaternion& q);

// The same rotation by a quaternion of size 1; q is not 0.
[[nodiscard]] Quaternion normalised(const Quaternion& q);

}  // namespace bbsim
