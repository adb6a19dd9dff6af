// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "equal_error.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::bench {
namespace {

struct Cost {
  double error, seconds;
};

// Points that no other point beats in both error and time, from the most accurate to the fastest.
std::vector<Cost> unbettered(const std::vector<Point>& points, const std::string& tool) {
  constexpr double rounding = 1e-18;  // m; zero has no logarithm
  std::vector<Cost> all, front;
  for (const Point& point : points) {
    if (point.tool == tool) all.push_back({std::max(point.error, rounding), point.seconds});
  }
  std::sort(all.begin(), all.end(), [](const Cost& a, const Cost& b) {
    return a.error < b.error || (a.error == b.error && a.seconds < b.seconds);
  });
  for (const Cost& cost : all) {
    if (front.empty() || cost.seconds < front.back().seconds) front.push_back(cost);
  }
  return front;
}

}  // namespace

std::optional<double> seconds_at(const std::vector<Point>& points, const std::string& tool,
                                 double error) {
  const std::vector<Cost> front = unbettered(points, tool);
  if (front.empty() || front.front().error > error) return {};
  const auto looser = std::find_if(front.begin(), front.end(),
                                   [error](const Cost& cost) { return cost.error > error; });
  if (looser == front.end()) return front.back().seconds;
  const Cost& a = *(looser - 1);
  const Cost& b = *looser;
  const double fraction = std::log(error / a.error) / std::log(b.error / a.error);
  return a.seconds * std::pow(b.seconds / a.seconds, fraction);
}

}  // namespace bbsim::bench
