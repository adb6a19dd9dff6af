// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a live page offers to change in its scenario.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/exercise.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::replay {

// A number that the text of a scenario has: its slider.
struct LiveKey {
  std::string key, text;              // controller.pd.kp, and its value as the text has it
  double value = 0;                   // SI
  std::optional<double> least, most;  // the range of allowed values, SI; empty: unbounded
  bool whole = false;                 // without fractions
};

struct Live {
  std::vector<LiveKey> keys;  // in the order of their names
  scenario::Exercise exercise;
};

// Throws InputError for a text that is no tree of keys, or a mistaken exercise.
[[nodiscard]] Live live_of(const Scenario& scenario);

}  // namespace bbsim::replay
