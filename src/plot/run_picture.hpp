// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs -> a picture: their paths in the plane, and columns over time.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"
#include "results/result.hpp"

namespace bbsim::plot {

using results::Result;

// What to draw: the columns of each panel, and the path if a list is the one word `path`. Empty:
// all that the runs have.
using Asked = std::vector<std::vector<std::string>>;

// One run, or several to be compared; at least one. Throws InputError if there is nothing to draw,
// or for a column that cannot be drawn as it is asked for.
[[nodiscard]] Picture run_picture(const std::vector<Result>& runs, const Asked& asked);

}  // namespace bbsim::plot
