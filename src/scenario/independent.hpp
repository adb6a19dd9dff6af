// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys of a scenario that no rule relates to any other key.
#pragma once

#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim {

// Where the number at that key stands in a scenario, more than once for a scalar gain. Empty if
// other keys decide what it may be, or if the scene has more than a ball on a gimbal that follows a
// given motion or equation (31): such a scenario has to be read anew for another value.
[[nodiscard]] std::vector<double*> independent_number(Scenario& scenario, std::string_view key);

}  // namespace bbsim
