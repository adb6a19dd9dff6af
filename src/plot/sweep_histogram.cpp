// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How often which value of a measure came.
#include <algorithm>
#include <cmath>
#include <utility>

#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr unsigned bars = 0x7fb8d8;  // of the blue of lines, paler

// The width as Freedman and Diaconis choose it, from the quartiles, within what can be seen.
std::size_t bin_count(std::vector<double>& values, double width) {
  const double between = quantile(values, 0.75) - quantile(values, 0.25);
  const double bin = 2 * between / std::cbrt(static_cast<double>(values.size()));
  const double count = bin > 0 ? width / bin : 10;
  return static_cast<std::size_t>(std::clamp(std::ceil(count), 5.0, 60.0));
}

// Digits that tell a hundredth of a range.
int digits_between(double low, double high) {
  const double part = (high - low) / std::max(std::abs(low), std::abs(high));
  return part > 0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(part))), 3, 12) : 4;
}

}  // namespace

void add_histogram(Picture& picture, const SweepTable& table, const Column& measure, Box box) {
  const MeasureAxis along(table, measure);
  std::vector<double> values;  // as they lie along the axis
  for (std::size_t i = 0; i < measure.numbers.size(); ++i) {
    if (!table.done(i) || !std::isfinite(measure.numbers[i])) continue;
    const double value = along.scale(measure.numbers[i]);
    values.push_back(along.log ? std::log(value) : value);
  }
  Panel panel;
  panel.box = box;
  panel.x = along.axis(box.width(), 70, 0.03);
  if (!along.log) panel.x = across(std::move(panel.x), box.width());
  const auto drawn = [&](double value) { return along.log ? std::exp(value) : value; };
  double most = 1;
  std::vector<Entry> legend;
  std::vector<std::pair<double, Stroke>> quantiles;
  if (!values.empty()) {
    std::ranges::sort(values);
    const double low = values.front(), width = values.back() - low;
    const std::size_t bins = along.range.wide() ? bin_count(values, width) : 1;
    std::vector<double> counts(bins, 0);
    for (const double value : values) {
      const double part = width > 0 ? (value - low) / width : 0;
      counts[std::min(static_cast<std::size_t>(part * static_cast<double>(bins)), bins - 1)] += 1;
    }
    most = *std::ranges::max_element(counts);
    // What is constant is one bar, not wider than others would be.
    const double thick = along.range.wide() ? width / static_cast<double>(bins)
                         : along.log        ? 0.05
                                            : (panel.x.high - panel.x.low) / 40;
    const double start = along.range.wide() ? low : low - thick / 2;
    for (std::size_t b = 0; b < bins; ++b) {
      if (counts[b] == 0) continue;
      const double left = start + thick * static_cast<double>(b);
      panel.cells.push_back({drawn(left), drawn(left + thick), 0, counts[b], bars});
    }
    const Stroke median{"#000000", 1.6}, tail{"#000000", 1.2, Dash::dashed};
    const double middle = drawn(quantile(values, 0.5));
    const double below = drawn(quantile(values, 0.05)), above = drawn(quantile(values, 0.95));
    const int digits = digits_between(drawn(values.front()), drawn(values.back()));
    const auto text = [digits](double value) { return number(value, digits); };
    quantiles = {{middle, median}, {below, tail}, {above, tail}};
    legend = {{"median " + text(middle), median},
              {"5 and 95 %: " + text(below) + ", " + text(above), tail}};
    if (text(below) == text(above)) legend = {{"all " + text(middle), median}};
  }
  panel.y = linear_axis({0, most * 1.05}, box.height(), 32, 0);
  for (const auto& [value, stroke] : quantiles) {
    panel.curves.push_back({Curve::Shape::line, stroke, {value, value}, {0, panel.y.high}});
  }
  // There is no half a case.
  std::erase_if(panel.y.tics, [](const Tic& tic) { return tic.at != std::round(tic.at); });
  add_heading(picture, box, "cases");
  place_legend(picture, legend, box.left + 70, box.right, box.top - 12);
  add_axis_label(picture, box, along.scale.heading(measure.name));
  picture.panels.push_back(std::move(panel));
}

}  // namespace bbsim::plot
