// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What an experiment plays: two functions of time.
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
  Pair step{0, 0};  // beside them: from 0 to this at `step_start`
  double step_start = 0;
  Pair position{0, 0}, velocity{0, 0};  // of the ball at the start, m and m/s
  bool centered = false;  // the ball may start where the path is about the plate's center

  [[nodiscard]] double value(std::size_t axis, double t) const;
  // With the ball's start.
  [[nodiscard]] Motion scaled(double by) const;
};

// A step of a plate with mass takes as long, s.
inline constexpr double rise_time = 0.1;

// A table that stands for the motion in a scenario's text: what the scenario does to it
// (value(t) = offset + scale * table(t - delay)) can be read off what becomes of these rows.
struct Placeholder {
  std::vector<double> times, values;
};
[[nodiscard]] Placeholder placeholder(double length);

// What the scenario does to its tables.
struct TableChange {
  double scale = 1, offset = 0, delay = 0;
};
[[nodiscard]] std::array<TableChange, 2> changes_of(const Scenario& scenario);

// Puts the motion in the placeholder's place, played such that it comes out as it is with the
// changes `nominal`; with others, it comes out changed. Up to `length` s.
void play(const Motion& motion, Plays plays, const std::array<TableChange, 2>& nominal,
          double length, Scenario& scenario);

// What a rig is told at time t, so that the motion comes out with these changes.
[[nodiscard]] double command(const Motion& motion, std::size_t axis, const TableChange& nominal,
                             double t);

}  // namespace bbsim::design
