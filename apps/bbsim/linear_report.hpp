// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a linearization says to a person, shared by `linearize` and `check`.
#pragma once

#include <string>
#include <vector>

#include "model/control/linearize.hpp"

namespace bbsim::app {

// A line each, with its label: margins of each command's loop, and the bandwidths.
struct LabelledLine {
  std::string label, text;
};
[[nodiscard]] std::vector<LabelledLine> margin_lines(const model::Linearization& made);

// Points of operation, names and units, poles, zeros and margins.
[[nodiscard]] std::string linear_report(const std::string& of, const model::Linearization& made);

}  // namespace bbsim::app
