// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/rotation.hpp"

#include <cmath>

namespace bbsim::replay {

std::vector<Quaternion> rolled(const std::vector<double>& x, const std::vector<double>& y,
                               const std::vector<double>* gamma, double radius) {
  std::vector<Quaternion> result;
  result.reserve(x.size());
  Quaternion now{1, 0, 0, 0};
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (row > 0) {
      const double dgamma = gamma == nullptr ? 0 : (*gamma)[row] - (*gamma)[row - 1];
      const std::array<double, 3> turn{-(y[row] - y[row - 1]) / radius,
                                       (x[row] - x[row - 1]) / radius, dgamma};
      if (std::isfinite(turn[0] + turn[1] + turn[2])) {
        now = normalised(product(rotation_by(turn), now));
      }
    }
    result.push_back(now);
  }
  return result;
}

namespace {

// The integral from the first row on, by trapezoids. Rows that are not finite add nothing.
std::vector<double> integral(const std::vector<double>& t, const std::vector<double>& rate) {
  std::vector<double> sum(t.size(), 0);
  for (std::size_t row = 1; row < t.size(); ++row) {
    const double more = (t[row] - t[row - 1]) * (rate[row] / 2 + rate[row - 1] / 2);
    sum[row] = sum[row - 1] + (std::isfinite(more) ? more : 0);
  }
  return sum;
}

// The part of the ball's path that its rotation covers: the path minus the slip.
std::vector<double> way_rolled(const Run& run, const char* axis, const char* slip) {
  std::vector<double> way = coordinate(run, axis);
  if (const Series* const rate = find_series(run, slip)) {
    const std::vector<double> slipped = integral(find_series(run, "t")->values, rate->values);
    for (std::size_t row = 0; row < way.size(); ++row) way[row] -= slipped[row];
  }
  return way;
}

}  // namespace

std::vector<Quaternion> orientation_of(const Run& run, double radius) {
  if (!run.orientation.empty()) return run.orientation;
  const Series* const gamma = find_series(run, "gamma");
  const Series* const spin = find_series(run, "spin");
  const bool slip_known = find_series(run, "slip_x") != nullptr &&
                          find_series(run, "slip_y") != nullptr &&
                          (gamma != nullptr || spin != nullptr) && run.ball_radius.has_value();
  if (!run.rolls && !slip_known) return {};
  std::vector<double> turned;
  if (gamma != nullptr) {
    turned = gamma->values;
  } else if (spin != nullptr) {
    turned = integral(find_series(run, "t")->values, spin->values);
  }
  return rolled(way_rolled(run, "x", "slip_x"), way_rolled(run, "y", "slip_y"),
                turned.empty() ? nullptr : &turned, run.rolling_radius.value_or(radius));
}

}  // namespace bbsim::replay
