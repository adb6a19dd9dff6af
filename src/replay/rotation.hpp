// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rotations of the ball on the plane.
#pragma once

#include <cstddef>
#include <vector>

#include "base/quaternion.hpp"
#include "replay/scene.hpp"

namespace bbsim::replay {

// Orientations of a rolling ball in the plane's frame, with the identity in the first row. Between
// two rows the ball rolls straight and pivots evenly, by the rotation (-dy/r, dx/r, dgamma). The
// error is of second order in the distance of rows; a run's integrated rotation is better. A null
// `gamma` means no pivoting. Rows with a value that is not finite repeat the last orientation.
[[nodiscard]] std::vector<Quaternion> rolled(const std::vector<double>& x,
                                             const std::vector<double>& y,
                                             const std::vector<double>* gamma, double radius);

// The recorded orientations of the run, if it has them. Otherwise rolled() with this radius, the
// pivoting of gamma or spin, and the slip of columns slip_x and slip_y; the error of the slip is of
// second order in the distance of rows. Empty if the columns do not determine the rotation.
[[nodiscard]] std::vector<Quaternion> orientation_of(const Run& run, double radius);

}  // namespace bbsim::replay
