// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws a histogram of a measure.
#include <algorithm>
#include <cmath>

#include "base/quantile.hpp"
#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

// Uses the bin width of Freedman and Diaconis, from the quartiles, within visible limits.
std::size_t bin_count(const std::vector<double>& sorted, double width) {
  const double between = quantile(sorted, 0.75) - quantile(sorted, 0.25);
  const double bin = 2 * between / std::cbrt(static_cast<double>(sorted.size()));
  const double count = bin > 0 ? width / bin : 10;
  return static_cast<std::size_t>(std::clamp(std::ceil(count), 5.0, 60.0));
}

// The number of digits that resolve a hundredth of a range.
int digits_between(double low, double high) {
  const double part = (high - low) / std::max(std::abs(low), std::abs(high));
  return part > 0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(part))), 3, 12) : 4;
}

void add_quantiles(Panel& panel, double below, double middle, double above, int digits) {
  const Stroke median{"#000000", 1.6}, tail{"#000000", 1.2, Dash::dashed};
  const auto add = [&](const char* name, double value, const Stroke& stroke) {
    panel.curves.push_back({Curve::Shape::line, stroke, {value, value}, {0, panel.y.high}});
    panel.legend.push_back({name + number(value, digits), stroke});
  };
  if (number(below, digits) == number(above, digits)) return add("all ", middle, median);
  add("5 %: ", below, tail);
  add("median ", middle, median);
  add("95 %: ", above, tail);
}

}  // namespace

Panel histogram_panel(const SweepPanel& of) {
  const MeasureAxis along(of.table, of.measure);
  std::vector<double> values;  // positions along the axis
  for (std::size_t i = 0; i < of.measure.numbers.size(); ++i) {
    if (!of.table.done(i) || !std::isfinite(of.measure.numbers[i])) continue;
    const double value = along.scale(of.measure.numbers[i]);
    values.push_back(along.log ? std::log(value) : value);
  }
  std::ranges::sort(values);
  Panel panel{of.box};
  panel.x = along.axis(Along::x, of.box.width(), 0.03);
  panel.x.label = along.scale.heading(of.measure.name);
  const auto drawn = [&](double value) { return along.log ? std::exp(value) : value; };
  double most = 1;
  if (!values.empty()) {
    const bool wide = along.range.wide();
    const double width = values.back() - values.front();
    const std::size_t bins = wide ? bin_count(values, width) : 1;
    // A constant measure has one bar, no wider than others would be.
    const double thick = wide        ? width / static_cast<double>(bins)
                         : along.log ? 0.05
                                     : (panel.x.high - panel.x.low) / 40;
    const double start = wide ? values.front() : values.front() - thick / 2;
    std::vector<double> counts(bins, 0);
    for (const double value : values) {
      counts[std::min(static_cast<std::size_t>((value - start) / thick), bins - 1)] += 1;
    }
    for (std::size_t b = 0; b < bins; ++b) {
      const double left = start + thick * static_cast<double>(b);
      panel.cells.push_back({drawn(left), drawn(left + thick), 0, counts[b]});
    }
    most = std::ranges::max(counts);
  }
  panel.y = linear_axis({0, most * 1.05}, Along::y, of.box.height(), 0);
  panel.y.step = std::max(panel.y.step, 1.0);  // cases are whole numbers
  panel.y.label = "cases";
  if (!values.empty()) {
    const int digits = digits_between(drawn(values.front()), drawn(values.back()));
    add_quantiles(panel, drawn(quantile(values, 0.05)), drawn(quantile(values, 0.5)),
                  drawn(quantile(values, 0.95)), digits);
  }
  return panel;
}

}  // namespace bbsim::plot
