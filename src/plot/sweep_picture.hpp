// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sweep -> a picture: its measures over the keys that vary.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"
#include "results/result.hpp"

namespace bbsim::plot {

using results::Result;

struct SweepChoice {
  std::vector<std::string> measures;  // empty: all that vary
  std::vector<std::string> over;      // one key or two; empty: chosen by what varies
};

// Over one key: lines, the median and where nine of ten cases lie if there are several at a value.
// Over two: maps, or where the second has few values, a line for each. If all keys were drawn by
// chance: histograms. Cases that did not end `done` have no part in these, and are marked.
//
// Throws InputError for a key or a measure that the sweep has not, and where nothing varies.
[[nodiscard]] Picture sweep_picture(const Result& sweep, const SweepChoice& choice);

}  // namespace bbsim::plot
