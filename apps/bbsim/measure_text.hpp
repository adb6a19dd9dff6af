// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures as the commands that take them print them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "command.hpp"

namespace bbsim::app {

// CSV: measure,value.
[[nodiscard]] std::string measure_text(const std::vector<std::pair<std::string, double>>& measures);

// --measure NAME,...; may be given again.
Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what);

// What a measure's name may be, for a command's help.
[[nodiscard]] std::string measures_footer();

}  // namespace bbsim::app
