// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws a measure over two keys, as colors.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/quantile.hpp"
#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr std::size_t most_cells = 160;  // along one side; more values share cells
// Numbers in cells have three digits.
constexpr double close_in_cells = 1e-2;
constexpr double scale_width = 110;  // of the color scale, with the gap

struct Cases {
  std::vector<double> done;
  std::string other{};  // status of the first case that is not done
};

// The cells along one side.
struct Side {
  std::vector<double> edges;  // of the cells
  double pixels;              // size of each

  Side(const KeyAxis& axis, double all_pixels) {
    const std::vector<double> all = axis.edges();
    const std::size_t values = axis.key.distinct.size(), cells = std::min(values, most_cells);
    for (std::size_t cell = 0; cell <= cells; ++cell) {
      edges.push_back(all[(cell * values + cells - 1) / cells]);
    }
    pixels = all_pixels / static_cast<double>(cells);
  }

  [[nodiscard]] std::size_t cell_of(const Key& key, double value) const {
    const auto found = std::ranges::lower_bound(key.distinct, value);
    const auto index = static_cast<std::size_t>(found - key.distinct.begin());
    return index * (edges.size() - 1) / key.distinct.size();
  }
};

}  // namespace

Panel map_panel(const SweepPanel& of, const Key& over, const Key& against) {
  Panel panel{of.box};
  panel.box.right -= scale_width;
  const double width = panel.box.width(), height = panel.box.height();
  const KeyAxis along(of.table, over), up(of.table, against);
  const MeasureAxis colours(of.table, of.measure, close_in_cells);
  panel.heading = colours.scale.heading(of.measure.name);
  panel.x = along.axis(Along::x, width, true);
  panel.y = up.axis(Along::y, height, true);
  panel.colours = colours.axis(Along::y, height, 0);
  panel.x.numbered = of.lowest;
  if (!of.lowest) panel.x.label.clear();

  const Side columns(along, width), rows(up, height);
  std::map<std::pair<std::size_t, std::size_t>, Cases> cells;
  for (std::size_t i = 0; i < over.values.size(); ++i) {
    if (std::isnan(over.values[i]) || std::isnan(against.values[i])) continue;
    Cases& cell =
        cells[{columns.cell_of(over, over.values[i]), rows.cell_of(against, against.values[i])}];
    if (of.table.done(i)) {
      if (std::isfinite(of.measure.numbers[i])) {
        cell.done.push_back(colours.scale(of.measure.numbers[i]));
      }
    } else if (cell.other.empty()) {
      cell.other = of.table.status[i];
    }
  }
  const bool with_numbers = columns.pixels >= 46 && rows.pixels >= 20;
  std::map<std::string, Curve> others;
  for (auto& [place, cases] : cells) {
    const std::size_t column = place.first, row = place.second;
    std::ranges::sort(cases.done);
    Cell cell{columns.edges[column], columns.edges[column + 1], rows.edges[row],
              rows.edges[row + 1], quantile(cases.done, 0.5)};
    if (!cases.other.empty()) {
      Curve& curve = others[cases.other];
      curve.stroke = stroke_of_status(of.table, cases.other);
      curve.stroke.marker_size = std::clamp(std::min(columns.pixels, rows.pixels) / 14, 0.25, 1.0);
      curve.add(panel.x.middle(cell.left, cell.right), panel.y.middle(cell.bottom, cell.top));
    } else if (with_numbers && std::isfinite(cell.value)) {
      cell.text = number(cell.value, 3);
    }
    panel.cells.push_back(std::move(cell));
  }
  for (auto& [status, curve] : others) panel.curves.push_back(std::move(curve));
  return panel;
}

}  // namespace bbsim::plot
