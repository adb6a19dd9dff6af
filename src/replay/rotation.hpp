// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rotations: of the gimbal's links and of the ball that rolls on the plane.
#pragma once

#include <cstddef>
#include <vector>

#include "base/quaternion.hpp"
#include "replay/scene.hpp"

namespace bbsim::replay {

// From the plane's frame to the world's: R of docs/explanation/model.md, (M15).
[[nodiscard]] Quaternion plane_orientation(const Mounting& mounting, double phi, double theta);

// Orientations of the ball in the plane's frame, from the identity, if between two rows it rolls
// straight and pivots evenly: by the rotation (-dy/r, dx/r, dgamma). Second order in the rows'
// distance; where a run has the integrated rotation, that is better. `gamma` may be nullptr: no
// pivoting. Rows in which something is not finite repeat the last orientation.
[[nodiscard]] std::vector<Quaternion> rolled(const std::vector<double>& x,
                                             const std::vector<double>& y,
                                             const std::vector<double>* gamma, double radius);

// The run's own orientations; or where it has none those of a ball of this radius that rolls
// (rolled()), or slips as columns slip_x and slip_y say, off by the square of the rows' distance,
// and pivots as gamma or spin do. Empty where the columns do not tell how the ball turns.
[[nodiscard]] std::vector<Quaternion> orientation_of(const Run& run, double radius);

}  // namespace bbsim::replay
