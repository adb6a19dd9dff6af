// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Changes values in the text of a scenario, and leaves all else as it is, comments too.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.hpp"

namespace bbsim {

// The text with these settings in it. A key that is not there joins its neighbors. A section is
// replaced as a whole. Throws InputError for a key that cannot be set there alone: one within an
// alias, or in a list.
[[nodiscard]] std::string edited_text(const std::string& text,
                                      const std::vector<ScenarioFamily::Setting>& settings);

}  // namespace bbsim
