// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks of what stands between servos and the plane, against closed forms of its geometry.
#pragma once

#include <functional>
#include <vector>

#include "study/verify.hpp"

namespace bbsim::study {

// That of configs/pushrod.yaml, whose horn and rod are in line beyond 60 degrees.
[[nodiscard]] RodLinkage push_rod();

[[nodiscard]] std::vector<std::function<Check()>> linkage_checks();

}  // namespace bbsim::study
