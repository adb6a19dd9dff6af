// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The paths of all keys of a scenario, for shells that complete them.
#pragma once

#include <string>
#include <vector>

namespace bbsim::scenario {

// Keys that take a value that is no mapping, sorted, with the positions of short lists:
// ball.position, ball.position.0, ball.position.1, ... Names that are the user's are left out:
// controller.program.parameters. stands for them.
[[nodiscard]] std::vector<std::string> key_paths();

}  // namespace bbsim::scenario
