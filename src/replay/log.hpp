// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the log of a real rig: any CSV, with any column names and units.
#pragma once

#include <string>

#include "plot/result.hpp"
#include "replay/scene.hpp"

namespace bbsim::replay {

// `map` assigns columns: "x=Ballx:mm,y=Bally:mm,t=Time:ms" gives a column of `bbsim columns`, the
// log's column and its unit, SI by default. Without t in the map, the log's column t is the time in
// seconds. With an empty map, the log has the names and units of bbsim. Throws InputError with the
// row of the log or the place in the map, the text found and the texts allowed.
[[nodiscard]] Run run_of_log(plot::Result log, const std::string& map, const std::string& name);

}  // namespace bbsim::replay
