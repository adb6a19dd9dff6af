// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys that a rig often needs and its scenario lacks.
#pragma once

#include <vector>

#include "fit/fit.hpp"

namespace bbsim::api {

// Keys that the scenario takes and a fit might free next: those of tables, ball, mounting, servos,
// delays and sensor that `task` does not free.
[[nodiscard]] std::vector<fit::FreeKey> fit_candidates(const fit::Task& task);

}  // namespace bbsim::api
