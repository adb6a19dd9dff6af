// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws a sweep: its measures over the keys that vary.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"
#include "results/result.hpp"

namespace bbsim::plot {

using results::Result;

struct SweepChoice {
  std::vector<std::string> measures;  // empty: all that vary
  std::vector<std::string> over;      // one key or two; empty: chosen automatically
};

// Over one key: lines through medians, and bands with nine of ten cases if a value has several.
// Over two: maps, or a line for each value of the second key if it has few. If all keys are random:
// histograms. These omit cases that are not `done`; marks show such cases.
//
// Throws InputError if the sweep lacks a key or measure, or if nothing varies.
[[nodiscard]] Picture sweep_picture(const Result& sweep, const SweepChoice& choice);

}  // namespace bbsim::plot
