// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "plot/text.hpp"
#include "scenario/columns.hpp"
#include "yaml/nearest.hpp"

namespace bbsim::plot {
namespace {

using scenario::find_result_column;

Unit drawn(std::string_view unit, bool turns) {
  constexpr double degrees = 180 / std::numbers::pi;
  if (unit == "1") return {};
  if (!turns && unit == "rad") return {"°", degrees};
  if (!turns && unit == "rad/s") return {"°/s", degrees};
  if (unit == "rad/s^2") return {"°/s²", degrees};
  return {std::string(unit)};
}

// The ball often makes many turns, which stay in rad.
bool is_turn(std::string_view column) {
  return column == "gamma" || column == "spin";
}

Unit drawn_unit(const std::vector<Result>& runs, std::string_view column, Drives driven) {
  const bool is_known = std::ranges::all_of(runs, &Result::units_known);
  if (!is_known || !scenario::is_command(column)) return unit_of(runs, column);
  return drawn(command_unit(driven), false);
}

PlannedLine line_of(std::string_view column) {
  const scenario::Column* const known = find_result_column(column);
  if (known == nullptr) return {std::string(column), Role::main, std::string(column)};
  return {std::string(column), known->role, std::string(known->symbol)};
}

bool draws(const std::vector<Result>& runs, std::string_view column) {
  return !range_of(runs, column).empty();
}

std::size_t count_of(const PlannedPanel& panel, Role role) {
  return static_cast<std::size_t>(std::ranges::count(panel.lines, role, &PlannedLine::role));
}

// The common quantity of all main lines; empty if they differ.
std::string_view common_name(const PlannedPanel& panel) {
  std::optional<scenario::Panel> common;
  for (const PlannedLine& line : panel.lines) {
    const scenario::Column* const known = find_result_column(line.column);
    if (line.role != Role::main) continue;
    if (known == nullptr || (common && *common != known->panel)) return "";
    common = known->panel;
  }
  return common ? scenario::text_of(*common).heading : "";
}

// Sets the panel's heading, and shortens names of lines that the heading completes.
void name_panel(PlannedPanel& panel) {
  const bool one = count_of(panel, Role::main) == 1;
  panel.name.clear();
  const std::string_view common = one ? "" : common_name(panel);
  if (!common.empty()) {
    panel.name = common;
    for (PlannedLine& line : panel.lines) {
      const scenario::Column* const known = find_result_column(line.column);
      if (known != nullptr && !known->beside.empty()) line.name = known->beside;
    }
    return;
  }
  for (PlannedLine& line : panel.lines) {
    const bool beside = line.role != Role::main;
    if (one && beside) {
      constexpr std::string_view names[] = {"", "reference", "as seen", "command"};
      line.name = names[static_cast<int>(line.role)];
    } else if (!beside || count_of(panel, Role::main) == 0) {
      panel.name += (panel.name.empty() ? "" : ", ") + line.name;
    }
  }
}

// Whether one of the lines would look flat beside another.
bool flattens(const std::vector<Result>& runs, const PlannedPanel& panel) {
  Range widths;
  for (const PlannedLine& line : panel.lines) {
    const Range range = range_of(runs, line.column);
    if (line.role == Role::main && range.wide()) widths.include(range.width());  // others are flat
  }
  return !widths.empty() && widths.high > 50 * widths.low;
}

// Makes a panel for each line that leads. Other lines join the panel of their axis, or else the
// first one.
template <class Leads>
void split_into(std::vector<PlannedPanel>& panels, const PlannedPanel& panel, Leads leads) {
  std::vector<PlannedPanel> parts;
  for (const PlannedLine& line : panel.lines) {
    if (leads(line.role)) parts.push_back({"", panel.unit, {line}});
  }
  if (parts.empty()) parts.push_back({"", panel.unit, {}});
  for (const PlannedLine& line : panel.lines) {
    if (leads(line.role)) continue;
    const auto partner = std::ranges::find_if(parts, [&](const PlannedPanel& part) {
      return !part.lines.empty() &&
             scenario::axis_of(part.lines.front().column) == scenario::axis_of(line.column);
    });
    (partner == parts.end() ? parts.front() : *partner).lines.push_back(line);
  }
  panels.insert(panels.end(), parts.begin(), parts.end());
}

std::vector<PlannedPanel> finish(const std::vector<Result>& runs,
                                 const std::vector<PlannedPanel>& wanted, bool may_split) {
  std::vector<PlannedPanel> panels;
  for (const PlannedPanel& panel : wanted) {
    if (runs.size() > 1) {
      // Lines of a panel differ by run, so two quantities cannot share one. References can, because
      // they are bands.
      split_into(panels, panel, [](Role role) { return role != Role::reference; });
    } else if (may_split && count_of(panel, Role::main) > 1 &&
               (flattens(runs, panel) || count_of(panel, Role::command) > 0)) {
      split_into(panels, panel, [](Role role) { return role == Role::main; });
    } else {
      panels.push_back(panel);
    }
  }
  for (PlannedPanel& panel : panels) name_panel(panel);
  return panels;
}

// Root mean square of u minus the angle, or minus its second derivative over time.
double misfit(const std::vector<double>& t, const std::vector<double>& u,
              const std::vector<double>& angle, bool second_derivative) {
  double sum = 0, count = 0;
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    if (!(before > 0) || !(std::abs(after - before) < 1e-6 * before)) continue;
    const double other = second_derivative
                             ? (angle[i + 1] - 2 * angle[i] + angle[i - 1]) / (before * after)
                             : angle[i];
    const double difference = u[i] - other;
    if (!std::isfinite(difference)) continue;
    sum += difference * difference;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// Lists the alternatives to a column that no run has.
std::string allowed(const Result& run, const std::string& name) {
  const std::vector<std::string> columns = run.names();
  std::vector<std::string_view> names(columns.begin(), columns.end());
  names.emplace_back("path");
  const std::string_view nearest = yaml::nearest_name(name, names);
  return (nearest.empty() ? "" : "; did you mean " + std::string(nearest) + "?") + "; " + run.file +
         " has " + joined(columns) + ", and path is their picture in the plane";
}

}  // namespace

Range range_of(const std::vector<Result>& runs, std::string_view column) {
  Range range;
  for (const Result& run : runs) {
    if (const Column* found = run.find(column)) range.include(found->numbers);
  }
  return range;
}

Unit unit_of(std::string_view column) {
  const scenario::Column* const found = find_result_column(column);
  return found == nullptr ? Unit{} : drawn(found->unit, is_turn(column));
}

Unit unit_of(const std::vector<Result>& runs, std::string_view column) {
  const auto tells_unit = [&](const Result& run) {
    const Column* const found = run.find(column);
    return run.units_known || found == nullptr || !found->unit.empty();
  };
  if (!std::ranges::all_of(runs, tells_unit)) return {};
  const scenario::Column* const known = find_result_column(column);
  if (known != nullptr) return unit_of(column);
  for (const Result& run : runs) {
    const Column* const found = run.find(column);
    if (found != nullptr && !found->unit.empty()) return drawn(found->unit, false);
  }
  return {};
}

Drives driven_quantity(const Result& run) {
  if (run.scenario && run.scenario->controller) return run.scenario->controller->drives;
  const Column* const t = run.find("t");
  double as_angle = 0, as_acceleration = 0;
  for (const char* axis : {"phi", "theta"}) {
    const Column* const angle = run.find(axis);
    const Column* const command = run.find(std::string(axis) + "_command");
    if (t == nullptr || angle == nullptr || command == nullptr) continue;
    as_angle += misfit(t->numbers, command->numbers, angle->numbers, false);
    as_acceleration += misfit(t->numbers, command->numbers, angle->numbers, true);
  }
  return as_acceleration < as_angle ? Drives::acceleration : Drives::angle;
}

std::vector<PlannedPanel> plan_panels(const std::vector<Result>& runs) {
  const Drives driven = driven_quantity(runs.front());
  std::vector<PlannedPanel> panels;
  for (int place = 0; place < static_cast<int>(scenario::Panel::none); ++place) {
    const auto at = static_cast<scenario::Panel>(place);
    PlannedPanel panel;
    const auto add = [&](const scenario::Column& column) {
      const std::string_view unit =
          scenario::is_command(column.name) ? command_unit(driven) : column.unit;
      if (scenario::panel_of(column, unit) != at || !draws(runs, column.name)) return;
      panel.unit = drawn_unit(runs, column.name, driven);
      panel.lines.push_back(line_of(column.name));
    };
    std::ranges::for_each(scenario::catalogue, add);
    add(scenario::position_error);
    if (panel.lines.empty()) continue;
    const bool pairs = at == scenario::Panel::y || at == scenario::Panel::theta;
    const auto plain = [](const PlannedPanel& one) {
      return one.lines.size() == 1 && one.lines.front().role == Role::main;
    };
    const std::string_view partner = at == scenario::Panel::y ? "x" : "phi";
    if (pairs && !panels.empty() && plain(panel) && plain(panels.back()) &&
        panels.back().lines.front().column == partner) {
      panels.back().lines.push_back(panel.lines.front());
    } else {
      panels.push_back(panel);
    }
  }
  for (const Result& run : runs) {
    for (const Column& column : run.columns) {
      const bool planned = std::ranges::any_of(panels, [&](const PlannedPanel& panel) {
        return std::ranges::find(panel.lines, column.name, &PlannedLine::column) !=
               panel.lines.end();
      });
      if (planned || column.name == "t" || !draws(runs, column.name)) continue;
      panels.push_back({"", unit_of(runs, column.name), {line_of(column.name)}});
    }
  }
  return finish(runs, panels, true);
}

std::vector<PlannedPanel> plan_panels(const std::vector<Result>& runs,
                                      const std::vector<std::vector<std::string>>& asked) {
  const Drives driven = driven_quantity(runs.front());
  std::vector<PlannedPanel> panels;
  for (const std::vector<std::string>& names : asked) {
    PlannedPanel panel;
    for (const std::string& name : names) {
      const std::string found = "--columns: found " + (name.empty() ? "nothing" : name);
      if (name == "t") throw InputError(found + ", over which the others are drawn");
      if (std::ranges::none_of(runs,
                               [&](const Result& run) { return run.find(name) != nullptr; })) {
        throw InputError(found + allowed(runs.front(), name));
      }
      if (!draws(runs, name)) throw InputError(found + ", which holds no finite number");
      const Unit unit = drawn_unit(runs, name, driven);
      if (!panel.lines.empty() && !(unit == panel.unit)) {
        throw InputError(found + " in a panel with " + panel.lines.front().column +
                         ", which has another unit; a semicolon begins another panel");
      }
      panel.unit = unit;
      panel.lines.push_back(line_of(name));
    }
    panels.push_back(panel);
  }
  return finish(runs, panels, false);
}

}  // namespace bbsim::plot
