// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What there is to say of a scene before it is run.
#pragma once

#include "api/report.hpp"
#include "api/watch.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// What is modelled and why, gains, poles, margins, the solver. Throws InputError.
[[nodiscard]] Report describe(const Scenario& scenario);

// The same, with the cases of the scenario's sweep block, all of which are checked, and with what
// its own controller says when it is started; it is asked for nothing.
[[nodiscard]] Report check(const Scenario& scenario, Watch& watch);

}  // namespace bbsim::api
