// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/thin.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

namespace bbsim::plot {
namespace {

bool grows(const std::vector<double>& x) {
  return std::ranges::adjacent_find(x, [](double a, double b) { return !(a <= b); }) == x.end();
}

template <class Places>
Curve only(const Curve& curve, const Places& kept) {
  Curve result{curve.shape, curve.stroke};
  for (const std::size_t i : kept) result.add(curve.x[i], curve.y[i]);
  return result;
}

}  // namespace

Curve thin_over_time(Curve curve, const Panel& panel) {
  const double pixels = panel.box.width();
  const std::size_t size = curve.x.size();
  if (static_cast<double>(size) < 4 * pixels || !grows(curve.x)) return curve;
  const auto pixel = [&](std::size_t i) {
    return std::floor(panel.x.fraction(curve.x[i]) * pixels);
  };
  std::set<std::size_t> kept;
  for (std::size_t first = 0, end = 0; first < size; first = end) {
    std::size_t low = first, high = first;
    for (end = first; end < size && pixel(end) == pixel(first); ++end) {
      const double y = curve.y[end];
      if (y < curve.y[low] || std::isnan(curve.y[low])) low = end;
      if (y > curve.y[high] || std::isnan(curve.y[high])) high = end;
      // A gap in a column of pixels is one point.
      if (std::isnan(y) && (end == first || !std::isnan(curve.y[end - 1]))) kept.insert(end);
    }
    kept.insert({first, low, high, end - 1});
  }
  return only(curve, kept);
}

Curve thin_path(Curve curve, const Panel& panel) {
  constexpr std::size_t few = 4000, most = 50000;
  if (curve.x.size() <= few) return curve;
  std::vector<std::size_t> kept;
  for (double distance = 0.25; distance == 0.25 || (kept.size() > most && distance < 100);
       distance *= 2) {
    kept.clear();
    double x = NAN, y = NAN;  // of the last point kept, in pixels
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double new_x = panel.x.fraction(curve.x[i]) * panel.box.width();
      const double new_y = panel.y.fraction(curve.y[i]) * panel.box.height();
      const bool near = std::hypot(new_x - x, new_y - y) < distance;  // not after or at a gap
      const bool gap_again = std::isnan(new_x + new_y) && std::isnan(x + y) && i > 0;
      if ((near || gap_again) && i + 1 < curve.x.size()) continue;
      kept.push_back(i);
      x = new_x;
      y = new_y;
    }
  }
  return only(curve, kept);
}

}  // namespace bbsim::plot
