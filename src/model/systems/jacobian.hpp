// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The exact Jacobian of any system, by forward-mode automatic differentiation, in one source file,
// because its instantiation for all systems takes longer to compile than all its callers.
#pragma once

#include "model/systems/list.hpp"

namespace bbsim::model {

// Writes d f_i / d z_j at (t, z) to matrix[i + size j] for a system of `size` states. Allocates
// nothing.
void jacobian(const System& system, double t, const double* z, double* matrix);

}  // namespace bbsim::model
