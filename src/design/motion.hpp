// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motion that an experiment plays: two functions of time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::design {

// The gimbal's angles phi and theta (rad), or a controller's reference x and y (m).
enum class Plays { tilts, reference };

struct Motion {
  std::array<std::vector<Sinusoid>, 2> sines{};
  Pair step{0, 0};  // added to the sines: from 0 to this at `step_start`
  double step_start = 0;
  Pair position{0, 0}, velocity{0, 0};  // of the ball at the start, m and m/s
  bool centered = false;  // whether the ball's start may move, to center its path on the plate

  [[nodiscard]] double value(std::size_t axis, double t) const;
  // Also scales the ball's start.
  [[nodiscard]] Motion scaled(double by) const;
};

// Duration of a step, s; a plate with mass takes as long.
inline constexpr double rise_time = 0.1;

// A table that represents the motion in a scenario's text. The resulting rows show what the
// scenario does to its tables: value(t) = offset + scale * table(t - delay).
struct Placeholder {
  std::vector<double> times, values;
};
[[nodiscard]] Placeholder placeholder(double length);

// The change that the scenario makes to a table.
struct TableChange {
  double scale = 1, offset = 0, delay = 0;
};
[[nodiscard]] std::array<TableChange, 2> changes_of(const Scenario& scenario);

// Replaces the placeholder with the motion, up to `length` s. The motion comes out unchanged if the
// scenario makes the changes `nominal`; with other changes, it comes out changed.
void play(const Motion& motion, Plays plays, const std::array<TableChange, 2>& nominal,
          double length, Scenario& scenario);

// The command at time t that makes the motion come out of a rig with these changes.
[[nodiscard]] double command(const Motion& motion, std::size_t axis, const TableChange& nominal,
                             double t);

}  // namespace bbsim::design
