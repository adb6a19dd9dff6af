// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws measures over one key, as lines or points.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/quantile.hpp"
#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

// Lines with more points have no markers.
constexpr std::size_t most_markers = 60;
// Random cases are points: small ones above the first number, only some above the second.
constexpr std::size_t many_points = 500, most_points = 20000;

// Positions of cases by other status, drawn as rows of marks at the bottom of the panel.
using Others = std::map<std::string, std::set<double>>;

void add_marks(Panel& panel, const Others& others, const SweepTable& table) {
  for (const auto& [status, places] : others) {
    Curve row{Curve::Shape::line, stroke_of_status(table, status)};
    for (const double x : places) row.add(x, panel.y.low);
    panel.curves.push_back(std::move(row));
  }
}

Panel empty_panel(const SweepPanel& of, const KeyAxis& along, const MeasureAxis& up) {
  Panel panel{of.box, up.scale.heading(of.measure.name)};
  panel.x = along.axis(Along::x, of.box.width(), false);
  panel.y = up.axis(Along::y, of.box.height(), 0.08);
  panel.x.numbered = of.lowest;
  if (!of.lowest) panel.x.label.clear();
  return panel;
}

Stroke stroke_of_group(std::size_t group) {
  constexpr std::array markers = {Marker::dot, Marker::triangle, Marker::filled_square,
                                  Marker::diamond, Marker::ring};
  Stroke stroke = stroke_of(group);
  stroke.marker = markers[group % markers.size()];
  return stroke;
}

std::string group_name(const Key& group, double value) {
  return group.name + " = " +
         (group.is_text() ? group.labels[static_cast<std::size_t>(value)] : number(value));
}

}  // namespace

std::vector<LegendEntry> group_legend(const Key* group) {
  std::vector<LegendEntry> entries;
  for (std::size_t g = 0; group != nullptr && g < group->distinct.size(); ++g) {
    entries.push_back({group_name(*group, group->distinct[g]), stroke_of_group(g)});
  }
  return entries;
}

Panel line_panel(const SweepPanel& of, const Key& over, const Key* group) {
  const KeyAxis along(of.table, over);
  const MeasureAxis up(of.table, of.measure);
  Panel panel = empty_panel(of, along, up);
  const std::vector<double> groups = group != nullptr ? group->distinct : std::vector<double>{0};
  const std::size_t cases = over.values.size(), every = over.drawn ? cases / most_points + 1 : 1;
  std::vector<Curve> lines;
  Others others;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::map<double, std::vector<double>> done;
    for (std::size_t i = 0; i < cases; i += every) {
      if (group != nullptr && group->values[i] != groups[g]) continue;
      std::vector<double>& bundle = done[over.values[i]];
      if (!of.table.done(i)) {
        others[of.table.status[i]].insert(along.place(over.values[i]));
      } else if (std::isfinite(of.measure.numbers[i])) {
        bundle.push_back(up.scale(of.measure.numbers[i]));
      }
    }
    Stroke stroke = stroke_of_group(g);
    if (over.distinct.size() > most_markers && !over.drawn) stroke.marker = Marker::none;
    if (over.is_text() || over.drawn) stroke.width = 0;  // no lines between texts or random values
    if (over.drawn && cases > many_points) stroke.marker_size = 0.4;
    Curve line{Curve::Shape::line, stroke}, band{Curve::Shape::band, stroke};
    bool several = false;
    for (auto& [value, bundle] : done) {
      several = several || bundle.size() > 1;
      std::ranges::sort(bundle);
      line.add(along.place(value), quantile(bundle, 0.5));
      band.add(along.place(value), quantile(bundle, 0.05));
      band.y_high.push_back(quantile(bundle, 0.95));
    }
    if (several && groups.size() <= most_bands) panel.curves.push_back(std::move(band));
    lines.push_back(std::move(line));
  }
  for (Curve& line : lines) panel.curves.push_back(std::move(line));
  add_marks(panel, others, of.table);
  return panel;
}

}  // namespace bbsim::plot
