// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Cases that cover a part of the scenario's time, from a state of their own.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::sweep {

// State at the start of a window (SI). The angles are those of gimbal.start, without the errors of
// the mounting; they matter only if a controller or torques move the gimbal.
using Start = std::array<double, 9>;
inline constexpr std::array<std::string_view, 9> start_names = {
    "x", "y", "vx", "vy", "phi", "theta", "phi_rate", "theta_rate", "spin"};

void set_start(Scenario& scenario, const Start& start);

// Whether the gimbal's state at a window's start is free: no given motion or commands set it.
[[nodiscard]] bool begins_anywhere(const Scenario& scenario);

// Removes the events that end a run early or only observe it.
void remove_events(Scenario& scenario);

// The window of `whole` from `begin` to `end` (s) as a scene. With played commands, the gimbal
// starts where the servos are after following the commands of the second before, and holding the
// first of them until then. At 0 it starts at gimbal.start, as in a run. Throws InputError if the
// tables of `whole` do not cover the window.
[[nodiscard]] Scenario window_of(const Scenario& whole, double begin, double end);

// What cases have beside the values of their keys. A list is empty, or has an entry for each case.
struct Windows {
  std::vector<double> begin, end;  // s; without them: 0, and the scenario's end
  std::vector<Start> start;        // at `begin`; without it: the scenario's
  bool events = true;

  [[nodiscard]] bool cut() const { return !begin.empty() || !end.empty(); }
  [[nodiscard]] double begin_of(std::size_t number) const {
    return begin.empty() ? 0 : begin[number];
  }
  [[nodiscard]] double end_of(std::size_t number, const Scenario& whole) const {
    return end.empty() ? whole.time.end : end[number];
  }
};

}  // namespace bbsim::sweep
