// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What `bbsim check` prints of a scene.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace bbsim::app {

// What is modelled and why, gains, poles, the solver; a line each, with `sweep` those of the
// scenario's sweep block too, whose values are checked. Throws InputError.
[[nodiscard]] std::string check_report(const Scenario& scenario, bool sweep);

}  // namespace bbsim::app
