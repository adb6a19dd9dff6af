// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/short_number.hpp"

namespace bbsim::design {
namespace {

constexpr double degree = 0.017453292519943295;
// Defaults without limits from scenario or caller: a hobby servo with a horn and a rod.
constexpr double usual_tilt = 10 * degree, usual_tilt_rate = 60 * degree;
// Usable part of a servo's limits: at the limits it no longer follows.
constexpr double share_of_servo = 0.95;
constexpr double unlimited = std::numeric_limits<double>::infinity();

// Whether servo and plate have the same angle.
bool is_direct(const Gimbal& gimbal) {
  return !gimbal.linkage[0] && !gimbal.linkage[1] && !gimbal.three_servos;
}

void limit_tilt(const Scenario& scenario, const LimitChoice& choice, Limits& limits) {
  if (choice.tilt) {
    limits.tilt = {*choice.tilt, *choice.tilt};
    limits.tilt_from = "--max-tilt";
    return;
  }
  limits.tilt = {unlimited, unlimited};
  const auto at_most = [&](std::size_t axis, std::optional<double> limit, const char* from) {
    if (!limit || !(*limit * share_of_servo < limits.tilt[axis])) return;
    limits.tilt[axis] = *limit * share_of_servo;
    limits.tilt_from = from;
  };
  const bool drives_tilts = scenario.controller && scenario.controller->drives == Drives::angle &&
                            is_direct(scenario.gimbal);
  for (std::size_t axis = 0; axis < 2 && drives_tilts; ++axis) {
    at_most(axis, scenario.controller->limit_of(axis), "controller.limit");
    if (scenario.gimbal.servo) {
      at_most(axis, scenario.gimbal.servo_of(axis).angle_limit, "gimbal.servo.angle_limit");
    }
  }
  if (scenario.events.tilt) {
    limits.total_tilt = scenario.events.tilt->limit;
    if (limits.tilt_from.empty()) limits.tilt_from = "events.tilt";
  }
  if (limits.tilt_from.empty()) limits.tilt_from = "usual; --max-tilt sets it";
  for (double& tilt : limits.tilt) {
    if (std::isinf(tilt)) tilt = limits.total_tilt.value_or(usual_tilt);
  }
}

void limit_rate(const Scenario& scenario, const LimitChoice& choice, Limits& limits) {
  limits.tilt_rate = {usual_tilt_rate, usual_tilt_rate};
  limits.tilt_rate_from = "usual; --max-tilt-rate sets it";
  if (choice.tilt_rate) {
    limits.tilt_rate = {*choice.tilt_rate, *choice.tilt_rate};
    limits.tilt_rate_from = "--max-tilt-rate";
    return;
  }
  if (!scenario.gimbal.servo || !is_direct(scenario.gimbal)) return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto limit = scenario.gimbal.servo_of(axis).rate_limit;
    if (!limit) continue;
    limits.tilt_rate[axis] = share_of_servo * *limit;
    limits.tilt_rate_from = "gimbal.servo.rate_limit";
  }
}

}  // namespace

Limits limits_of(const Scenario& scenario, const LimitChoice& choice) {
  const Plate& plate = scenario.plate;
  if (!plate.size && !plate.diameter) {
    throw InputError(
        "plate: has no size, but the ball must stay on it; allowed: with plate.size or "
        "plate.diameter, such as --set \"plate.size=[30 cm, 30 cm]\"");
  }
  Limits limits;
  const double shorter =
      plate.size ? std::min((*plate.size)[0], (*plate.size)[1]) : *plate.diameter;
  const double margin = choice.margin.value_or(shorter / 10);
  if (!(margin >= 0) || !(margin < shorter / 2)) {
    throw InputError("--margin: found " + short_number(margin) +
                     " m; allowed: a length from 0 to below half the plate, " +
                     short_number(shorter / 2) + " m");
  }
  if (plate.size) {
    limits.rectangle = Pair{(*plate.size)[0] / 2 - margin, (*plate.size)[1] / 2 - margin};
  } else {
    limits.disc = *plate.diameter / 2 - margin;
  }
  limit_tilt(scenario, choice, limits);
  limit_rate(scenario, choice, limits);
  if (scenario.events.slip) limits.friction = scenario.events.slip->friction;
  return limits;
}

std::array<double, 10> Use::all() const {
  return {edge[0], edge[1],      edge[2],      edge[3],    tilt[0],
          tilt[1], tilt_rate[0], tilt_rate[1], total_tilt, friction};
}

double Use::greatest() const {
  return std::ranges::max(all());
}

double Use::greatest_edge() const {
  return std::ranges::max(edge);
}

double Use::greatest_tilt() const {
  return std::max({tilt[0], tilt[1], total_tilt});
}

double Use::greatest_tilt_rate() const {
  return std::max(tilt_rate[0], tilt_rate[1]);
}

std::vector<std::string> columns_of_use(const Limits& limits) {
  std::vector<std::string> names{"x", "y", "phi", "theta", "phi_rate", "theta_rate"};
  if (limits.friction) names.emplace_back("friction_demand");
  if (limits.total_tilt) names.emplace_back("tilt");
  return names;
}

Use use_of(const Limits& limits, const std::vector<double>& values) {
  const std::size_t rows = values.size() / columns_of_use(limits).size();
  const auto at = [&](std::size_t column, std::size_t row) { return values[column * rows + row]; };
  Use use;
  for (const std::size_t axis : {0U, 1U}) {
    const auto* const first = values.data() + axis * rows;
    const auto [least, most] = std::minmax_element(first, first + rows);
    use.middle[axis] = (*least + *most) / 2;
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const Pair ball{at(0, i), at(1, i)}, tilt{std::abs(at(2, i)), std::abs(at(3, i))};
    if (limits.disc)
      use.edge[0] = std::max(use.edge[0], std::hypot(ball[0], ball[1]) / *limits.disc);
    for (const std::size_t axis : {0U, 1U}) {
      if (limits.rectangle) {
        const double share = ball[axis] / (*limits.rectangle)[axis];
        use.edge[2 * axis] = std::max(use.edge[2 * axis], share);
        use.edge[2 * axis + 1] = std::max(use.edge[2 * axis + 1], -share);
      }
      use.tilt[axis] = std::max(use.tilt[axis], tilt[axis] / limits.tilt[axis]);
      use.tilt_rate[axis] =
          std::max(use.tilt_rate[axis], std::abs(at(4 + axis, i)) / limits.tilt_rate[axis]);
    }
    if (limits.friction) use.friction = std::max(use.friction, at(6, i) / *limits.friction);
    if (limits.total_tilt) {
      const double angle = at(limits.friction ? 7 : 6, i);
      use.total_tilt = std::max(use.total_tilt, angle / *limits.total_tilt);
    }
  }
  return use;
}

}  // namespace bbsim::design
