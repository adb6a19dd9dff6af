// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Columns over time, with the commands, references and limits that belong to them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plot/run_parts.hpp"
#include "plot/text.hpp"
#include "plot/thin.hpp"

namespace bbsim::plot {
namespace {

const Stroke limit{"#000000", 1.2, Dash::dashed};

// More marks than these stand at the panels' top only, without lines through them.
constexpr std::size_t most_uprights = 40;

// Between two commands a sampled controller holds the last one; so does a sensor. A law without
// samples has commands at all times.
bool is_held(const Result& run, Role role) {
  if (role == Role::measured) return true;
  const bool smooth =
      run.scenario && run.scenario->controller && !run.scenario->controller->sampling;
  return role == Role::command && !smooth;
}

Stroke stroke_in(const std::vector<Result>& runs, const Result& run, Role role,
                 std::size_t main_before) {
  const bool one = runs.size() == 1;
  switch (role) {
    case Role::reference:
      return band_of_reference;
    case Role::measured:
      return one ? Stroke{"#f2c45c", 4} : stroke_of_run(runs, run);
    case Role::command:
      return one ? Stroke{"#707070", 1.2} : stroke_of_run(runs, run);
    case Role::main:
      break;
  }
  return one ? stroke_of(main_before) : stroke_of_run(runs, run);
}

// References and what was seen are bands, under the thin lines of commands and of what was.
int layer(Role role) {
  constexpr std::array layers = {3, 0, 1, 2};
  return layers[static_cast<std::size_t>(role)];
}

std::vector<double> friction_limits(const std::vector<Result>& runs, const PlannedPanel& planned) {
  std::vector<double> limits;
  const bool about_friction = std::ranges::any_of(
      planned.lines, [](const PlannedLine& line) { return line.column == "friction_demand"; });
  for (const Result& run : runs) {
    if (!about_friction || !run.scenario || !run.scenario->events.slip) continue;
    const double friction = run.scenario->events.slip->friction;
    if (std::ranges::find(limits, friction) == limits.end()) limits.push_back(friction);
  }
  return limits;
}

// Without two neighbours that are numbers no line would be seen.
bool is_line(const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (std::isfinite(values[i - 1]) && std::isfinite(values[i])) return true;
  }
  return false;
}

}  // namespace

void add_time_panel(Picture& picture, const std::vector<Result>& runs, const PlannedPanel& planned,
                    const Abscissa& abscissa, const EventMarks& marks, Box box, bool lowest) {
  Range range;
  for (const Result& run : runs) {
    for (const PlannedLine& line : planned.lines) {
      if (const Column* column = run.find(line.column)) range.include(column->numbers);
    }
  }
  const std::vector<double> limits = friction_limits(runs, planned);
  Range shown = range;
  for (const double value : limits) shown.include(value);
  // A limit that is far away is left to its label.
  const bool limit_in_sight = shown.high - shown.low < 20 * (range.high - range.low);
  if (!limit_in_sight) shown = range;

  const Scale scale = choose_scale(planned.unit, shown);
  Panel panel;
  panel.box = box;
  panel.x =
      across(tight_axis({abscissa.scale(abscissa.range.low), abscissa.scale(abscissa.range.high)},
                        box.width(), 70),
             box.width());
  panel.y = linear_axis({scale(shown.low), scale(shown.high)}, box.height(), 26);
  if (!lowest) {
    for (Tic& tic : panel.x.tics) tic.label.clear();
  }

  std::vector<Entry> legend;
  struct Drawn {
    int layer;
    Curve curve;
  };
  std::vector<Drawn> drawn;
  const bool named = planned.lines.size() > 1;
  for (const Result& run : runs) {
    std::size_t mains = 0;
    for (const PlannedLine& line : planned.lines) {
      Stroke stroke = stroke_in(runs, run, line.role, mains);
      if (line.role == Role::main) ++mains;
      const bool first_run = &run == &runs.front();
      if (named && first_run && (runs.size() == 1 || line.role == Role::reference)) {
        legend.push_back({line.name, stroke});
      }
      const Column* const column = run.find(line.column);
      if (column == nullptr) continue;
      Curve curve{is_held(run, line.role) ? Curve::Shape::steps : Curve::Shape::line, stroke,
                  abscissa.of(run), column->numbers};
      if (!is_line(curve.y)) curve.stroke.marker = Marker::dot;
      for (double& value : curve.y) value = scale(value);
      if (curve.stroke.marker == Marker::none) {
        if (Curve lone = lone_points(curve); !lone.x.empty()) {
          drawn.push_back({layer(line.role), thin_over_time(std::move(lone), panel)});
        }
      }
      drawn.push_back({layer(line.role), thin_over_time(std::move(curve), panel)});
    }
  }
  std::ranges::stable_sort(drawn, {}, &Drawn::layer);
  for (Drawn& one : drawn) panel.curves.push_back(std::move(one.curve));
  for (const double value : limits) {
    legend.push_back(
        {"coefficient " + number(value) + (limit_in_sight ? "" : ", far above"), limit});
    if (!limit_in_sight) continue;
    panel.curves.push_back(
        {Curve::Shape::line, limit, {panel.x.low, panel.x.high}, {scale(value), scale(value)}});
  }
  if (abscissa.is_time) {
    for (const Result& run : runs) {
      for (const Event& event : run.events) {
        Stroke stroke = marks.stroke_of(run, event);
        if (run.events.size() > most_uprights) stroke.width = 0;
        panel.uprights.push_back({abscissa.scale(event.t), stroke});
      }
    }
  }
  const std::string heading = scale.heading(planned.name);
  add_heading(picture, box, heading);
  place_in_a_row(picture, legend, box.left + 20 + width_of(heading, 13), box.right, box.top - 12);
  picture.panels.push_back(std::move(panel));
}

}  // namespace bbsim::plot
