// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The exact Jacobian of whichever system a model is: in one place, since that of all systems takes
// a compiler longer than all that makes use of it.
#pragma once

#include "model/systems/list.hpp"

namespace bbsim::model {

// d f_i / d z_j at (t, z) in matrix[i + size j], of a system of `size` states. No allocation.
void jacobian(const System& system, double t, const double* z, double* matrix);

}  // namespace bbsim::model
