// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds keys of a scenario that no rule relates to other keys.
#pragma once

#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim {

// Pointers to the numbers that the key sets in the scenario; a scalar gain sets two. Empty if the
// valid values depend on other keys, or if the scene has more than a ball on a gimbal with
// prescribed motion or equation (31). The scenario must then be read again for each value.
[[nodiscard]] std::vector<double*> independent_number(Scenario& scenario, std::string_view key);

}  // namespace bbsim
