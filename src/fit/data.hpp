// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a fit compares: logs, cut into windows.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/family.hpp"

namespace bbsim::fit {

// A log of a rig, in SI units.
struct Log {
  std::string name;
  std::vector<double> times;                // s, by the scenario's clock; increasing
  std::vector<std::vector<double>> values;  // of each compared column; NaN where a row lacks one
  std::vector<ScenarioFamily::Setting> settings{};  // that make the scenario this log's
};

// A part of a log, whose start is fitted.
struct Window {
  std::size_t log = 0;
  double begin = 0;           // s
  std::vector<double> times;  // from `begin` on, s
  std::vector<std::vector<double>> values;
  bool first = false;    // of its log: it starts where the scenario does
  bool held = false;     // out of the fit
  bool goes_on = false;  // the next window follows without a gap
};

// Cuts logs into windows of `length` (s); a rest of less than half of it joins the window before.
// Of windows without more than `fewest` numbers nothing could be told; they are left out. Holds out
// each window i for which floor((i + 1) share) > floor(i share).
[[nodiscard]] std::vector<Window> cut(const std::vector<Log>& logs, double length, double share,
                                      std::size_t fewest);

// Says of each window whether the next one follows without a gap: after no more than five of the
// intervals between its rows.
void find_joints(std::vector<Window>& windows);

// Whether the numbers of a column are positions, velocities and so on of the ball along axis 0 or
// 1; the coordinates of a window's start that they tell.
[[nodiscard]] std::vector<std::size_t> start_coordinates(
    const std::vector<const scenario::Column*>& columns, bool with_gimbal);

}  // namespace bbsim::fit
