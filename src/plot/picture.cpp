// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/picture.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace bbsim::plot {

double Axis::fraction(double value) const {
  if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  if (!log) return (value / 2 - low / 2) / (high / 2 - low / 2);  // halves: no range overflows
  if (value <= 0) return std::numeric_limits<double>::quiet_NaN();
  return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

Curve lone_points(const Curve& line) {
  Curve lone{Curve::Shape::line, line.stroke, {}, {}};
  lone.stroke.width = 0;
  lone.stroke.marker = Marker::dot;
  lone.stroke.marker_size = 0.5;
  const auto drawn = [&](std::size_t i) {
    return i < line.x.size() && std::isfinite(line.x[i]) && std::isfinite(line.y[i]);
  };
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (!drawn(i) || drawn(i + 1) || (i > 0 && drawn(i - 1))) continue;
    lone.x.push_back(line.x[i]);
    lone.y.push_back(line.y[i]);
  }
  return lone;
}

}  // namespace bbsim::plot
