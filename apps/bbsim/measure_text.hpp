// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures as the commands that take them print them.
#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "scenario/measures.hpp"

namespace bbsim::app {

// CSV: measure,value.
[[nodiscard]] std::string measure_text(const std::vector<scenario::Measure>& measures,
                                       const std::vector<double>& values);

// --measure NAME,...; may be given again.
Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what);

// What a measure's name may be, for a command's help.
[[nodiscard]] std::string measures_footer();

}  // namespace bbsim::app
