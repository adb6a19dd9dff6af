// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A measure over two keys, as colours.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr std::size_t most_cells = 160;  // along one side; more are drawn as their medians
// Numbers in cells have three digits.
constexpr double close_in_cells = 1e-2;
constexpr unsigned not_done = 0xd9d9d9;

// Viridis, at equal distances: its lightness grows with the value, for print and for all eyes.
unsigned colour_of(double part) {
  constexpr std::array<std::uint32_t, 9> stops = {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                                  0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};
  const double place = std::clamp(part, 0.0, 1.0) * (stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  unsigned rgb = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double low = (stops[below] >> shift) & 0xFFU, high = (stops[below + 1] >> shift) & 0xFFU;
    const double mixed = std::lerp(low, high, place - static_cast<double>(below));
    rgb |= static_cast<unsigned>(std::lround(mixed)) << shift;
  }
  return rgb;
}

struct Cases {
  std::vector<double> done;
  std::string other{};  // how the first one ended that is not
};

std::size_t place_of(const Key& key, double value) {
  const auto found = std::ranges::lower_bound(key.distinct, value);
  const auto index = static_cast<std::size_t>(found - key.distinct.begin());
  return index * std::min(key.distinct.size(), most_cells) / key.distinct.size();
}

// Where the cells along a side begin, and the last one ends.
std::vector<double> cell_edges(const KeyAxis& axis) {
  const std::vector<double> edges = axis.edges();
  const std::size_t values = axis.key.distinct.size(), cells = std::min(values, most_cells);
  std::vector<double> result;
  for (std::size_t cell = 0; cell <= cells; ++cell) {
    result.push_back(edges[(cell * values + cells - 1) / cells]);
  }
  return result;
}

// The middle as the eye sees it.
double middle(const Axis& axis, double low, double high) {
  return axis.log ? std::sqrt(low) * std::sqrt(high) : low / 2 + high / 2;
}

void add_colour_scale(Picture& picture, const MeasureAxis& measure, const Box& map) {
  constexpr double gap = 16, width = 14;
  constexpr int steps = 64;
  Panel scale;
  scale.box = {map.right + gap, map.top, map.right + gap + width, map.bottom};
  scale.grid = false;
  scale.framed = true;
  scale.is_scale = true;
  scale.x = {0, 1};
  scale.y = measure.axis(map.height(), 32, 0);
  scale.y.at_right = true;
  const Axis& axis = scale.y;
  for (int i = 0; i < steps; ++i) {
    const auto at = [&](int step) {
      const double part = static_cast<double>(step) / steps;
      return axis.log ? std::exp(std::lerp(std::log(axis.low), std::log(axis.high), part))
                      : std::lerp(axis.low, axis.high, part);
    };
    scale.cells.push_back({0, 1, at(i), at(i + 1), colour_of((i + 0.5) / steps)});
  }
  picture.panels.push_back(std::move(scale));
}

}  // namespace

void add_map(Picture& picture, const SweepTable& table, const Column& measure, const Key& over,
             const Key& against, const StatusMarks& marks, Box box, bool lowest) {
  box.right -= map_scale_width;
  const KeyAxis along(table, over), up(table, against);
  const MeasureAxis colours(table, measure, close_in_cells);
  Panel panel;
  panel.box = box;
  panel.grid = false;
  panel.framed = true;
  panel.x = along.axis_across(box.width(), true);
  panel.y = up.axis(box.height(), 30, true);
  if (!lowest) {
    for (Tic& tic : panel.x.tics) tic.label.clear();
  }
  std::map<std::pair<std::size_t, std::size_t>, Cases> cells;
  for (std::size_t i = 0; i < over.values.size(); ++i) {
    if (std::isnan(over.values[i]) || std::isnan(against.values[i])) continue;
    Cases& cell = cells[{place_of(over, over.values[i]), place_of(against, against.values[i])}];
    if (table.done(i)) {
      if (std::isfinite(measure.numbers[i])) cell.done.push_back(measure.numbers[i]);
    } else if (cell.other.empty()) {
      cell.other = table.status[i];
    }
  }
  const std::vector<double> x = cell_edges(along), y = cell_edges(up);
  const double cell_width = box.width() / static_cast<double>(x.size() - 1);
  const double cell_height = box.height() / static_cast<double>(y.size() - 1);
  const bool with_numbers = cell_width >= 46 && cell_height >= 20;
  const Axis scale = colours.axis(box.height(), 32, 0);
  std::map<std::string, Curve> others;
  for (auto& [place, cell] : cells) {
    const auto [column, row] = place;
    const double value = colours.scale(quantile(cell.done, 0.5));
    const double part = scale.fraction(value);
    const Cell drawn{x[column], x[column + 1], y[row], y[row + 1],
                     std::isnan(part) ? not_done : colour_of(part)};
    panel.cells.push_back(drawn);
    const double centre_x = middle(panel.x, drawn.left, drawn.right);
    const double centre_y = middle(panel.y, drawn.bottom, drawn.top);
    if (!cell.other.empty()) {
      Curve& curve = others[cell.other];
      curve.stroke = marks.stroke_of(cell.other);
      curve.stroke.marker_size = std::clamp(std::min(cell_width, cell_height) / 14, 0.25, 1.0);
      curve.x.push_back(centre_x);
      curve.y.push_back(centre_y);
    } else if (with_numbers && !std::isnan(part)) {
      picture.words.push_back({Words::Align::centre,
                               box.left + box.width() * panel.x.fraction(centre_x),
                               box.bottom - box.height() * panel.y.fraction(centre_y),
                               number(value, 3), 11, part > 0.55 ? "#000000" : "#ffffff"});
    }
  }
  for (auto& [status, curve] : others) panel.curves.push_back(std::move(curve));
  add_heading(picture, box, colours.scale.heading(measure.name));
  picture.words.push_back({Words::Align::centre, box.left - 66, (box.top + box.bottom) / 2,
                           cut_middle(up.label, box.height(), 13), 13, "#202020", true});
  if (lowest) add_axis_label(picture, box, along.label);
  picture.panels.push_back(std::move(panel));
  if (!colours.range.empty()) add_colour_scale(picture, colours, box);
}

}  // namespace bbsim::plot
