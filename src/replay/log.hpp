// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The log of a real rig: any CSV, with names and units that are its own.
#pragma once

#include <string>

#include "plot/result.hpp"
#include "replay/scene.hpp"

namespace bbsim::replay {

// `map` says which columns are what, "x=Ballx:mm,y=Bally:mm,t=Time:ms": a column of `bbsim
// columns`, the log's, and its unit, SI if none is given. Without t in it, the log's own column t
// is the time in seconds. With an empty map the log's columns are named and measured as bbsim's
// are. Throws InputError: the log's row, or the place in the map, what was found, what is allowed.
[[nodiscard]] Run run_of_log(plot::Result log, const std::string& map, const std::string& name);

}  // namespace bbsim::replay
