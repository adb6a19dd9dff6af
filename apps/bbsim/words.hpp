// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Completion: completion.bash asks `bbsim --words WORD...` how the last word may go on.
#pragma once

#include <CLI/App.hpp>
#include <span>
#include <string>

namespace bbsim::app {

// One candidate a line; none where a file may stand. `app` has all commands, and the options of
// those among `words`, which begin after the program's name.
[[nodiscard]] std::string candidates(CLI::App& app, std::span<const std::string> words);

}  // namespace bbsim::app
