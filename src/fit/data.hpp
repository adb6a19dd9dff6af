// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Data of a fit: logs, cut into windows.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/family.hpp"

namespace bbsim::fit {

// A log of a rig in SI units.
struct Log {
  std::string name;
  std::vector<double> times;                // s, by the scenario's clock; increasing
  std::vector<std::vector<double>> values;  // per compared column; NaN where a row has no value
  std::vector<ScenarioFamily::Setting> settings{};  // turn the scenario into this log's
};

// A part of a log with a fitted start.
struct Window {
  std::size_t log = 0;
  double begin = 0;           // s
  std::vector<double> times;  // from `begin` on, s
  std::vector<std::vector<double>> values;
  bool first = false;    // of its log; starts where the scenario does
  bool held = false;     // held out of the fit
  bool goes_on = false;  // the next window follows without a gap
};

// Cuts logs into windows of `length` (s); a remainder of less than half of it joins the window
// before. Drops windows with no more than `fewest` numbers, which determine nothing. Holds out each
// window i for which floor((i + 1) share) > floor(i share).
[[nodiscard]] std::vector<Window> cut(const std::vector<Log>& logs, double length, double share,
                                      std::size_t fewest);

// Sets goes_on of each window: whether the pause to the next is at most five intervals of rows.
void find_joints(std::vector<Window>& windows);

// Coordinates of a window's start that the columns determine. Columns of the ball's position or
// velocity concern axis 0 or 1; any other column concerns both.
[[nodiscard]] std::vector<std::size_t> start_coordinates(
    const std::vector<const scenario::Column*>& columns, bool with_gimbal);

}  // namespace bbsim::fit
