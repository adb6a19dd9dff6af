// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Assigns columns of runs to panels, with their names and units there.
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

// Makes a panel for each quantity of the runs, in an order that suits a control engineer: the
// ball's position, the gimbal's motion, forces. x and y, or phi and theta, share a panel if it has
// no other quantity. With several runs, each panel has one quantity. Columns that bbsim does not
// know have their own panels.
[[nodiscard]] std::vector<PlannedPanel> plan_panels(const std::vector<Result>& runs);

// Makes a panel for each list of columns. Throws InputError for an empty list, for t, and for a
// column that no run has, that holds no number, or whose unit differs from its neighbors'.
[[nodiscard]] std::vector<PlannedPanel> plan_panels(
    const std::vector<Result>& runs, const std::vector<std::vector<std::string>>& asked);

// The range of a column's numbers in all of these runs.
[[nodiscard]] Range range_of(const std::vector<Result>& runs, std::string_view column);

// The unit in which a column of `bbsim columns` is drawn.
[[nodiscard]] Unit unit_of(std::string_view column);

// The unit in which a column of these runs is drawn: that of `bbsim columns`, or else the file's.
// Empty if one of the runs does not tell it (Result::units_known).
[[nodiscard]] Unit unit_of(const std::vector<Result>& runs, std::string_view column);

// The meaning of the command columns, from the scenario. Without one, angles or accelerations,
// whichever fits the commands better.
[[nodiscard]] Drives driven_quantity(const Result& run);

}  // namespace bbsim::plot
