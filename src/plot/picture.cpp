// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bbsim::plot {

Stroke stroke_of(std::size_t line) {
  constexpr std::array colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000"};
  constexpr std::array dashes = {Dash::solid, Dash::dashed, Dash::dotted, Dash::dash_dotted};
  return {colours[line % colours.size()], 2, dashes[line % dashes.size()]};
}

double Axis::fraction(double value) const {
  if (log) return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
  return (value - low) / (high - low);
}

double Axis::middle(double from, double to) const {
  return log ? std::sqrt(from) * std::sqrt(to) : from / 2 + to / 2;
}

int Axis::decimals() const {
  if (step == 0) return 0;
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
}

void Curve::add(double new_x, double new_y) {
  x.push_back(new_x);
  y.push_back(new_y);
}

Curve lone_points(const Curve& line) {
  Curve lone{Curve::Shape::line, {line.stroke.colour, 0, Dash::solid, Marker::dot, 0.8}};
  const auto drawn = [&](std::size_t i) {
    return i < line.x.size() && std::isfinite(line.x[i]) && std::isfinite(line.y[i]);
  };
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (drawn(i) && !drawn(i + 1) && (i == 0 || !drawn(i - 1))) lone.add(line.x[i], line.y[i]);
  }
  return lone;
}

}  // namespace bbsim::plot
