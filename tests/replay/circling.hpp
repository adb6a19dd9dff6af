// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run for tests.
#pragma once

#include <cmath>
#include <cstddef>

#include "replay/scene.hpp"

namespace bbsim_test {

// A ball on a tilting plate that moves around a circle of 5 cm in `rows` rows of 10 ms.
inline bbsim::replay::Run circling(std::size_t rows) {
  bbsim::replay::Run run;
  run.name = "circle.csv";
  run.title = "A circle";
  run.status = "done";
  run.scenario.emplace();
  run.scenario->ball.radius = 0.01;
  run.scenario->plate.size = {0.3, 0.2};
  run.columns = {{"t", {}, {}, "s"},          {"x", {}, {}, "m"},
                 {"y", {}, {}, "m"},          {"phi", {}, {}, "rad"},
                 {"theta", {}, {}, "rad"},    {"x_reference", {}, {}, "m"},
                 {"y_reference", {}, {}, "m"}};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const double values[] = {t,
                             0.05 * std::cos(0.3 * t),
                             -0.05 * std::sin(0.3 * t),
                             0.02 * std::sin(t),
                             0.03 * std::cos(0.7 * t),
                             0.052 * std::cos(0.3 * t),
                             -0.052 * std::sin(0.3 * t)};
    for (std::size_t c = 0; c < run.columns.size(); ++c)
      run.columns[c].numbers.push_back(values[c]);
  }
  return run;
}

}  // namespace bbsim_test
