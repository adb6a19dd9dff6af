// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What there is to say of a scene before it is run.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// What a line is about, and what there is to say of it; without a label it goes on.
struct Line {
  std::string label, text;
};
using Report = std::vector<Line>;

// A line each, the labels in a column.
[[nodiscard]] inline std::string to_text(const Report& report) {
  constexpr std::size_t width = 12;
  std::string text;
  for (const Line& line : report) {
    std::string label = line.label;
    label.resize(std::max(width, label.size()), ' ');
    text += label + ' ' + line.text + '\n';
  }
  return text;
}

// What is modelled and why, gains, poles, margins, the solver. Throws InputError.
[[nodiscard]] Report describe(const Scenario& scenario);

// The same, with the cases of the scenario's sweep block, all of which are checked, and with what
// its own controller answers when it is started and asked (probe.hpp). Throws
// model::ControllerFault.
[[nodiscard]] Report check(const Scenario& scenario, Watch& watch);

}  // namespace bbsim::api
