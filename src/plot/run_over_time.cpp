// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws columns over time, with their commands, references and limits.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "plot/run_parts.hpp"
#include "plot/text.hpp"
#include "plot/thin.hpp"

namespace bbsim::plot {
namespace {

// With more events, marks stand at the panels' top only, without lines.
constexpr std::size_t most_uprights = 40;

// A sampled controller holds each command until the next one; a sensor holds its value. A law
// without samples has commands at all times.
bool is_held(const Result& run, Role role) {
  if (role == Role::measured) return true;
  const bool smooth =
      run.scenario && run.scenario->controller && !run.scenario->controller->sampling;
  return role == Role::command && !smooth;
}

Stroke stroke_in(const std::vector<Result>& runs, const Result& run, Role role,
                 std::size_t main_before) {
  if (role == Role::reference) return band_of_reference;
  if (runs.size() > 1) return stroke_of_run(runs, run);
  if (role == Role::measured) return {"#f2c45c", 4};
  if (role == Role::command) return {"#707070", 1.2};
  return stroke_of(main_before);
}

std::set<double> friction_limits(const std::vector<Result>& runs, const PlannedPanel& planned) {
  std::set<double> limits;
  if (std::ranges::find(planned.lines, "friction_demand", &PlannedLine::column) ==
      planned.lines.end()) {
    return limits;
  }
  for (const Result& run : runs) {
    if (run.scenario && run.scenario->events.slip) {
      limits.insert(run.scenario->events.slip->friction);
    }
  }
  return limits;
}

// Marks events at the top of the panel, with vertical lines if they are few.
void add_events(Panel& panel, const Result& run, const Abscissa& abscissa,
                const EventMarks& marks) {
  std::map<std::string, Curve> rows;
  for (const Event& event : run.events) {
    const double t = abscissa.scale(event.t);
    Curve& row = rows[event.name];
    row.stroke = marks.stroke_of(run, event.name);
    row.add(t, panel.y.high);
    if (run.events.size() > most_uprights) continue;
    Curve upright{Curve::Shape::line, {row.stroke.colour, 1, Dash::dotted}};
    upright.add(t, panel.y.low);
    upright.add(t, panel.y.high);
    panel.curves.push_back(std::move(upright));
  }
  for (auto& [event, row] : rows) panel.curves.push_back(std::move(row));
}

}  // namespace

Panel time_panel(const std::vector<Result>& runs, const PlannedPanel& planned,
                 const Abscissa& abscissa, const EventMarks& marks, const Box& box, bool lowest) {
  Range range;
  for (const PlannedLine& line : planned.lines) range.include(range_of(runs, line.column));
  const std::set<double> limits = friction_limits(runs, planned);
  Range shown = range;
  for (const double value : limits) shown.include(value);
  // A limit far away appears only in the legend.
  const bool limit_in_sight = shown.width() < 20 * range.width();
  if (!limit_in_sight) shown = range;

  const Scale scale = choose_scale(planned.unit, shown);
  Panel panel{box, scale.heading(planned.name)};
  panel.x = linear_axis(abscissa.range, Along::x, box.width(), 0);
  panel.x.numbered = lowest;
  if (lowest) panel.x.label = abscissa.scale.heading(abscissa.is_time ? "t" : "row");
  panel.y = linear_axis(scale(shown), Along::y, box.height());

  // References and measurements are bands below the thin lines of commands and the motion.
  std::map<Role, std::vector<Curve>> layers;
  for (const Result& run : runs) {
    std::size_t mains = 0;
    for (const PlannedLine& line : planned.lines) {
      const Stroke stroke = stroke_in(runs, run, line.role, mains);
      if (line.role == Role::main) ++mains;
      const bool first_run = &run == &runs.front();
      if (planned.lines.size() > 1 && first_run &&
          (runs.size() == 1 || line.role == Role::reference)) {
        panel.legend.push_back({line.name, stroke});
      }
      const Column* const column = run.find(line.column);
      if (column == nullptr) continue;
      Curve curve{is_held(run, line.role) ? Curve::Shape::steps : Curve::Shape::line, stroke,
                  abscissa.of(run), column->numbers};
      for (double& value : curve.y) value = scale(value);
      layers[line.role].push_back(thin_over_time(lone_points(curve), panel));
      layers[line.role].push_back(thin_over_time(std::move(curve), panel));
    }
  }
  for (const Role role : {Role::reference, Role::measured, Role::command, Role::main}) {
    for (Curve& curve : layers[role]) {
      if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
    }
  }
  const Stroke limit{"#000000", 1.2, Dash::dashed};
  std::string coefficients;
  for (const double value : limits) {
    coefficients += (coefficients.empty() ? "coefficient " : ", ") + number(value);
    if (!limit_in_sight) continue;
    panel.curves.push_back(
        {Curve::Shape::line, limit, {panel.x.low, panel.x.high}, {scale(value), scale(value)}});
  }
  if (!limits.empty()) {
    panel.legend.push_back({coefficients + (limit_in_sight ? "" : ", far above"), limit});
  }
  if (abscissa.is_time) {
    for (const Result& run : runs) add_events(panel, run, abscissa, marks);
  }
  return panel;
}

}  // namespace bbsim::plot
