// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which columns of runs share a panel, what they are called there, and in which unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plot/axis.hpp"
#include "results/result.hpp"
#include "scenario/columns.hpp"

namespace bbsim::plot {

using results::Column;
using results::Result;

using scenario::Role;

struct PlannedLine {
  std::string column;
  Role role = Role::main;
  std::string name;  // in a legend
};

struct PlannedPanel {
  std::string name;  // its heading, without the unit
  Unit unit;
  std::vector<PlannedLine> lines;
};

// A panel for each quantity that any of the runs has, in an order that suits a control engineer:
// where the ball is, what the gimbal does, forces. x beside y, and phi beside theta, share a panel
// if nothing else stands in it. Of several runs each panel has one quantity. What is in no
// catalogue has a panel of its own.
[[nodiscard]] std::vector<PlannedPanel> plan_panels(const std::vector<Result>& runs);

// A panel for each list of columns. Throws InputError for a column that no run has, that holds no
// number, or whose unit is not that of its neighbours; for an empty list; and for t.
[[nodiscard]] std::vector<PlannedPanel> plan_panels(
    const std::vector<Result>& runs, const std::vector<std::vector<std::string>>& asked);

// What the numbers of a column span in all of these runs.
[[nodiscard]] Range range_of(const std::vector<Result>& runs, std::string_view column);

// The unit in which a column of `bbsim columns` is drawn.
[[nodiscard]] Unit unit_of(std::string_view column);

// The unit in which a column of these runs is drawn: as a file says, or as `bbsim columns` does.
// None where one of the runs does not tell (Result::units_known).
[[nodiscard]] Unit unit_of(const std::vector<Result>& runs, std::string_view column);

// What the command columns are: as the scenario says, or if there is none, angles or accelerations,
// whichever the commands resemble more.
[[nodiscard]] Drives driven_quantity(const Result& run);

}  // namespace bbsim::plot
