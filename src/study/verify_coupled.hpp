// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks of losses, sliding, torques and linked servos against closed forms, and of their energy
// balance.
#pragma once

#include <functional>
#include <vector>

#include "study/verify.hpp"

namespace bbsim::study {

[[nodiscard]] std::vector<std::function<Check()>> coupled_checks(const solve::Watch& watch);

}  // namespace bbsim::study
