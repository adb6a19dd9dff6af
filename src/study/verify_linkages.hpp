// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks of the linkages between servos and plate against closed forms of their geometry.
#pragma once

#include <functional>
#include <vector>

#include "study/verify.hpp"

namespace bbsim::study {

// The linkage of configs/pushrod.yaml. Its horn and rod are in line beyond 60 degrees.
[[nodiscard]] RodLinkage push_rod();

[[nodiscard]] std::vector<std::function<Check()>> linkage_checks();

}  // namespace bbsim::study
