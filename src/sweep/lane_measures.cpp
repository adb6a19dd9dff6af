// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/lane_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace bbsim::sweep {

using Kind = scenario::Measure::Kind;

bool are_usual_measures(const std::vector<scenario::Measure>& measures) {
  return std::ranges::all_of(measures, [](const scenario::Measure& measure) {
    if (!measure.window.is_whole()) return false;
    if (measure.kind == Kind::end) return measure.column->needs != scenario::Needs::gamma;
    return size_of(measure) ||
           (measure.kind == Kind::rms && measure.column->name == "tracking_error");
  });
}

std::optional<solve::Size> size_of(const scenario::Measure& measure) {
  if (measure.kind != Kind::greatest) return {};
  const std::string_view name = measure.column->name;
  if (name == "tilt") return solve::versine;
  if (name == "tilt_rate") return solve::rate_squared;
  if (name == "distance") return solve::distance_squared;
  if (name == "tracking_error") return solve::error_squared;
  return {};
}

double value_of(solve::Size size, double value) {
  if (size != solve::versine) return std::sqrt(value);
  return value < 1 ? 2 * std::asin(std::sqrt(value / 2))
                   : std::numbers::pi - 2 * std::asin(std::sqrt(std::max(0.0, 1 - value / 2)));
}

}  // namespace bbsim::sweep
