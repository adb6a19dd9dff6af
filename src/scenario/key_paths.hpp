// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The paths of all keys of a scenario, for completion in shells.
#pragma once

#include <string>
#include <vector>

namespace bbsim::scenario {

// Sorted paths of keys whose value is not a mapping, with the positions of short lists:
// ball.position, ball.position.0, ball.position.1, ... A prefix, such as
// controller.program.parameters., stands for names that the user chooses.
[[nodiscard]] std::vector<std::string> key_paths();

}  // namespace bbsim::scenario
