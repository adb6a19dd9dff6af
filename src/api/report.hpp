// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is found out about a scene, for people.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

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

}  // namespace bbsim::api
