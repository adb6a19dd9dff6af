// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Changes values in the text of a scenario and keeps everything else, comments included.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.hpp"

namespace bbsim {

// Returns the text with these settings. Inserts a missing key beside its neighbors. Replaces a
// section as a whole. Throws InputError for a key that cannot be set alone, such as a section that
// an alias shares or that is an item of a list.
[[nodiscard]] std::string edited_text(const std::string& text,
                                      const std::vector<ScenarioFamily::Setting>& settings);

// The text of a source with its overrides, then these settings, below comments. Throws as
// edited_text() does.
[[nodiscard]] std::string edited_scenario(const Source& source, const std::string& comments,
                                          const std::vector<ScenarioFamily::Setting>& settings);

}  // namespace bbsim
