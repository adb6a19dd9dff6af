// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws runs: their paths in the plane, and columns over time.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"
#include "results/result.hpp"

namespace bbsim::plot {

using results::Result;

// The requested columns of each panel. A list with the single word `path` means the path. Empty:
// everything that the runs have.
using Asked = std::vector<std::vector<std::string>>;

// Draws one run or compares several. Throws InputError if there is nothing to draw, or for a column
// that cannot be drawn as requested.
[[nodiscard]] Picture run_picture(const std::vector<Result>& runs, const Asked& asked);

}  // namespace bbsim::plot
