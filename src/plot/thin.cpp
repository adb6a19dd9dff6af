// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/thin.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bbsim::plot {
namespace {

bool grows(const std::vector<double>& x) {
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] >= x[i - 1])) return false;
  }
  return true;
}

Curve only(const Curve& curve, const std::vector<std::size_t>& kept) {
  Curve result{curve.shape, curve.stroke, {}, {}};
  result.x.reserve(kept.size());
  result.y.reserve(kept.size());
  for (const std::size_t i : kept) {
    result.x.push_back(curve.x[i]);
    result.y.push_back(curve.y[i]);
  }
  return result;
}

// The points kept of those in one column of pixels.
class PixelColumn {
 public:
  explicit PixelColumn(const Curve& curve) : curve_(curve) {}

  void add(std::size_t i) {
    const double y = curve_.y[i];
    if (count_ == 0) first_ = low_ = high_ = i;
    if (y < curve_.y[low_] || std::isnan(curve_.y[low_])) low_ = i;
    if (y > curve_.y[high_] || std::isnan(curve_.y[high_])) high_ = i;
    if (std::isnan(y)) gap_ = i;
    last_ = i;
    ++count_;
  }

  void flush(std::vector<std::size_t>& kept) {
    if (count_ == 0) return;
    // They go in order, each once. A gap in a column of pixels is one point.
    std::vector<std::size_t> found{first_, low_, high_, last_};
    if (gap_ != none) found.push_back(gap_);
    std::sort(found.begin(), found.end());
    for (const std::size_t i : found) {
      if (kept.empty() || i > kept.back()) kept.push_back(i);
    }
    count_ = 0;
    gap_ = none;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  const Curve& curve_;
  std::size_t count_ = 0, first_ = 0, low_ = 0, high_ = 0, last_ = 0, gap_ = none;
};

}  // namespace

Curve thin_over_time(Curve curve, const Panel& panel) {
  const double pixels = panel.box.width();
  if (static_cast<double>(curve.x.size()) < 4 * pixels || !grows(curve.x)) return curve;
  std::vector<std::size_t> kept;
  PixelColumn column(curve);
  double current = -1;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double at = std::floor(panel.x.fraction(curve.x[i]) * pixels);
    if (at != current) column.flush(kept);
    current = at;
    column.add(i);
  }
  column.flush(kept);
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
