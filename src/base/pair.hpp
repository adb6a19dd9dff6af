// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Two numbers, and 2x2 matrices.
#pragma once

#include <array>

namespace bbsim {

using Pair = std::array<double, 2>;   // (x, y), or (phi, theta)
using Matrix2 = std::array<Pair, 2>;  // rows phi, theta; columns x, y

}  // namespace bbsim
