// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scales of keys, of which derivatives are differences.
#pragma once

#include <Eigen/Core>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

// Makes a key's scale smaller by which the logs change by more than ten times their noise, as
// `windows` has it: its differences would be those of another rig. `windows` must be of `task`.
// Returns the root mean square change of the logs by each scale, in noise.
Eigen::VectorXd scale_keys(Task& task, WindowsFit& windows, const Eigen::VectorXd& u);

}  // namespace bbsim::fit
