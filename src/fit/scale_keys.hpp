// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scales of keys, which set the step of difference quotients.
#pragma once

#include <Eigen/Core>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// Reduces the scale of each key that changes the logs by more than ten times the noise of
// `windows`: such differences would be those of another rig. `windows` must belong to `task`.
// Returns the root mean square change of the logs per scale, relative to the noise.
Eigen::VectorXd scale_keys(Task& task, WindowsFit& windows, const Eigen::VectorXd& u);

}  // namespace bbsim::fit
