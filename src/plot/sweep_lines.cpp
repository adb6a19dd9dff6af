// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures over one key, as lines or as points.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "plot/columns.hpp"
#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

// Lines with more points carry no markers.
constexpr std::size_t most_markers = 60;
constexpr std::size_t most_points = 20000;

// The cases of a group at a value.
struct Bundle {
  std::vector<double> done;
  std::vector<std::string> others{};  // how those ended that are not
};

// Ways to end, each once for each value: a row of marks at the foot of the panel.
void add_marks(Panel& panel, const std::map<double, Bundle>& bundles, const KeyAxis& axis,
               const StatusMarks& marks) {
  std::map<std::string, Curve> rows;
  for (const auto& [value, bundle] : bundles) {
    for (const std::string& status : bundle.others) {
      Curve& row = rows[status];
      row.stroke = marks.stroke_of(status);
      const double x = axis.place(value);
      if (!row.x.empty() && row.x.back() == x) continue;
      row.x.push_back(x);
      row.y.push_back(panel.y.low);
    }
  }
  for (auto& [status, row] : rows) panel.curves.push_back(std::move(row));
}

Panel empty_panel(const KeyAxis& along, const MeasureAxis& up, const Box& box, bool lowest) {
  Panel panel;
  panel.box = box;
  panel.x = along.axis_across(box.width(), false);
  panel.y = up.axis(box.height(), 28, 0.08);
  if (!lowest) {
    for (Tic& tic : panel.x.tics) tic.label.clear();
  }
  return panel;
}

std::string pale(const std::string& colour) {
  constexpr int base = 16;
  std::string result = "#";
  for (std::size_t i = 1; i < colour.size(); i += 2) {
    const int part = std::stoi(colour.substr(i, 2), nullptr, base);
    const int paler = 255 - (255 - part) / 4;
    constexpr std::string_view digits = "0123456789abcdef";
    result += digits[static_cast<std::size_t>(paler / base)];
    result += digits[static_cast<std::size_t>(paler % base)];
  }
  return result;
}

Stroke stroke_of_group(std::size_t group) {
  constexpr std::array markers = {Marker::dot, Marker::triangle, Marker::filled_square,
                                  Marker::diamond, Marker::ring};
  Stroke stroke = stroke_of(group);
  stroke.marker = markers[group % markers.size()];
  return stroke;
}

std::string group_name(const Key& group, double value) {
  return clean(group.name) + " = " +
         (group.is_text() ? clean(group.labels[static_cast<std::size_t>(value)]) : number(value));
}

}  // namespace

std::vector<Entry> group_legend(const Key* group) {
  std::vector<Entry> entries;
  for (std::size_t g = 0; group != nullptr && g < group->distinct.size(); ++g) {
    entries.push_back({group_name(*group, group->distinct[g]), stroke_of_group(g)});
  }
  return entries;
}

void add_lines(Picture& picture, const SweepTable& table, const Column& measure, const Key& over,
               const Key* group, const StatusMarks& marks, Box box, bool lowest) {
  const KeyAxis along(table, over);
  const MeasureAxis up(table, measure);
  Panel panel = empty_panel(along, up, box, lowest);
  const std::vector<double> groups = group != nullptr ? group->distinct : std::vector<double>{0};
  std::vector<Curve> bands, lines;
  std::map<double, Bundle> all;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::map<double, Bundle> bundles;
    for (std::size_t i = 0; i < over.values.size(); ++i) {
      if (group != nullptr && group->values[i] != groups[g]) continue;
      Bundle& bundle = bundles[over.values[i]];
      if (!table.done(i)) {
        bundle.others.push_back(table.status[i]);
        all[over.values[i]].others.push_back(table.status[i]);
      } else if (std::isfinite(measure.numbers[i])) {
        bundle.done.push_back(measure.numbers[i]);
      }
    }
    Stroke stroke = stroke_of_group(g);
    if (over.distinct.size() > most_markers) stroke.marker = Marker::none;
    if (over.is_text()) stroke.width = 0;  // nothing lies between two words
    Curve line{Curve::Shape::line, stroke, {}, {}};
    Curve band{Curve::Shape::band, {pale(stroke.colour)}, {}, {}, {}};
    bool several = false;
    for (auto& [value, bundle] : bundles) {
      several = several || bundle.done.size() > 1;
      line.x.push_back(along.place(value));
      line.y.push_back(up.scale(quantile(bundle.done, 0.5)));
      band.x.push_back(line.x.back());
      band.y.push_back(up.scale(quantile(bundle.done, 0.05)));
      band.y_high.push_back(up.scale(quantile(bundle.done, 0.95)));
    }
    if (several && groups.size() <= most_bands) bands.push_back(std::move(band));
    lines.push_back(std::move(line));
  }
  for (Curve& band : bands) panel.curves.push_back(std::move(band));
  for (Curve& line : lines) panel.curves.push_back(std::move(line));
  add_marks(panel, all, along, marks);
  add_heading(picture, box, up.scale.heading(measure.name));
  if (lowest) add_axis_label(picture, box, along.label);
  picture.panels.push_back(std::move(panel));
}

void add_scatter(Picture& picture, const SweepTable& table, const Column& measure, const Key& over,
                 const StatusMarks& marks, Box box, bool lowest) {
  const KeyAxis along(table, over);
  const MeasureAxis up(table, measure);
  Panel panel = empty_panel(along, up, box, lowest);
  const bool many = over.values.size() > 500;
  Curve points{
      Curve::Shape::line, {"#0072b2", 0, Dash::solid, Marker::dot, many ? 0.4 : 0.9}, {}, {}};
  std::map<double, Bundle> others;
  const std::size_t every = over.values.size() / most_points + 1;
  for (std::size_t i = 0; i < over.values.size(); i += every) {
    if (!table.done(i)) {
      others[over.values[i]].others.push_back(table.status[i]);
      continue;
    }
    points.x.push_back(along.place(over.values[i]));
    points.y.push_back(up.scale(measure.numbers[i]));
  }
  panel.curves.push_back(std::move(points));
  add_marks(panel, others, along, marks);
  add_heading(picture, box, up.scale.heading(measure.name));
  if (lowest) add_axis_label(picture, box, along.label);
  picture.panels.push_back(std::move(panel));
}

}  // namespace bbsim::plot
