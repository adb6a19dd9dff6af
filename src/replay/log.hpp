// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the log of a real rig: any CSV, with any column names and units.
#pragma once

#include <string>
#include <vector>

#include "replay/scene.hpp"
#include "results/log.hpp"
#include "results/result.hpp"

namespace bbsim::replay {

// Without maps, the log has the names and units of bbsim. With maps, the run has only the columns
// that they name, and the log's own t. Adds the changes to `notes`. Throws InputError with the row
// of the log or the place in the map, the text found and the texts allowed.
[[nodiscard]] Run run_of_log(results::Result log, const results::LogChoice& choice,
                             const std::string& name, std::vector<std::string>& notes);

}  // namespace bbsim::replay
