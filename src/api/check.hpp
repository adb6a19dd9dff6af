// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Description of a scene before its run.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// Subject and text of a line; a line without a label continues the one before.
struct Line {
  std::string label, text;
};
using Report = std::vector<Line>;

constexpr std::size_t label_width = 12;

// One line each, with the labels in a column.
[[nodiscard]] inline std::string to_text(const Report& report) {
  std::string text;
  for (const Line& line : report) {
    std::string label = line.label;
    label.resize(std::max(label_width, label.size()), ' ');
    text += label + ' ' + line.text + '\n';
  }
  return text;
}

// Describes the model and its reasons, gains, poles, margins and the solver. Throws InputError.
[[nodiscard]] Report describe(const Scenario& scenario);

// The same, with the cases of the scenario's sweep block, all checked, and the answers of the
// user's controller to test samples (probe(), linearize.hpp). `reasons`: also says why the solver
// was chosen, and whether the scene is stiff. Throws model::ControllerFault.
[[nodiscard]] Report check(const Scenario& scenario, Watch& watch, bool reasons = false);

}  // namespace bbsim::api
