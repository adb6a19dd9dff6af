// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Designs the motion whose log tells most about keys of a scenario, and predicts its accuracy.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/experiment.hpp"

namespace bbsim::design {

struct Expected {
  std::string key, unit;  // SI
  double value = 0;
  double sd = 0;  // infinite if the log does not determine it
  // `sd` with a circle and a step of the same length; empty if none keeps the limits.
  std::optional<double> circle{}, step{};
};

struct Designed {
  bool interrupted = false;
  Motion motion;
  std::array<TableChange, 2> nominal{};
  std::vector<Expected> parameters;
  Use use;
  std::optional<double> circle_frequency{};  // rad/s
  std::size_t windows = 0, numbers = 0, tried = 0;
};

// `written` returns the family of the scenario that plays the motion from a table of rows, which
// serves to check the prediction. Throws InputError if no motion keeps the limits, and for keys
// that change nothing.
[[nodiscard]] Designed design(const Task& task,
                              const std::function<ScenarioFamily(const Designed&)>& written);

}  // namespace bbsim::design
