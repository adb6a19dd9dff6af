// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Limits on the motion of a rig.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::design {

struct Limits {
  // On the ball's distance from the plate's center: along x and y, or in any direction, m.
  std::optional<Pair> rectangle{};
  std::optional<double> disc{};
  Pair tilt{0, 0};                        // on phi and theta, rad
  std::optional<double> total_tilt{};     // between the plate's normal and the vertical, rad
  Pair tilt_rate{0, 0};                   // rad/s
  std::optional<double> friction{};       // largest permitted friction demand
  std::string tilt_from, tilt_rate_from;  // the sources of these limits, in words
};

// Limits from the caller, which replace those of the scenario.
struct LimitChoice {
  std::optional<double> tilt{}, tilt_rate{}, margin{};
};

// Throws InputError if the plate has no size, or if the margin leaves nothing of it.
[[nodiscard]] Limits limits_of(const Scenario& scenario, const LimitChoice& choice);

// The fraction of each limit that a motion uses; 1 is all of it.
struct Use {
  std::array<double, 4> edge{};  // toward x, -x, y and -y
  Pair tilt{0, 0}, tilt_rate{0, 0};
  double total_tilt = 0, friction = 0;
  Pair middle{0, 0};  // of the ball's path, m

  [[nodiscard]] std::array<double, 10> all() const;
  [[nodiscard]] double greatest() const;
  [[nodiscard]] double greatest_edge() const;
  [[nodiscard]] double greatest_tilt() const;
  [[nodiscard]] double greatest_tilt_rate() const;
};

// The columns that use_of() needs, and the use for their values, column after column.
[[nodiscard]] std::vector<std::string> columns_of_use(const Limits& limits);
[[nodiscard]] Use use_of(const Limits& limits, const std::vector<double>& values);

}  // namespace bbsim::design
