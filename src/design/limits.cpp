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
// Where neither scenario nor caller says: a hobby servo's through a horn and a rod.
constexpr double usual_tilt = 10 * degree, usual_tilt_rate = 60 * degree;
// Of a servo's limits: at them it no longer follows.
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
  if (!limits.tilt_from.empty()) return;
  limits.tilt = {usual_tilt, usual_tilt};
  limits.tilt_from = "usual; --max-tilt sets it";
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
        "plate: has no size, and the ball shall stay on it; allowed: with plate.size or "
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

double Use::greatest() const {
  return std::max({edge, tilt, tilt_rate, friction});
}

std::vector<std::string> columns_of_use(const Limits& limits) {
  std::vector<std::string> names{"x", "y", "phi", "theta", "phi_rate", "theta_rate"};
  if (limits.friction) names.emplace_back("friction_demand");
  return names;
}

Use use_of(const Limits& limits, const std::vector<double>& values) {
  const std::size_t rows = values.size() / columns_of_use(limits).size();
  const auto size = [&](std::size_t column, std::size_t row) {
    return std::abs(values[column * rows + row]);
  };
  Use use;
  for (std::size_t i = 0; i < rows; ++i) {
    const double x = size(0, i), y = size(1, i), phi = size(2, i), theta = size(3, i);
    const double edge = limits.rectangle
                            ? std::max(x / (*limits.rectangle)[0], y / (*limits.rectangle)[1])
                            : std::hypot(x, y) / *limits.disc;
    use.edge = std::max(use.edge, edge);
    use.tilt = std::max({use.tilt, phi / limits.tilt[0], theta / limits.tilt[1]});
    // The angle between normal and vertical is less than the root of the squares.
    if (limits.total_tilt)
      use.tilt = std::max(use.tilt, std::hypot(phi, theta) / *limits.total_tilt);
    use.tilt_rate = std::max(
        {use.tilt_rate, size(4, i) / limits.tilt_rate[0], size(5, i) / limits.tilt_rate[1]});
    if (limits.friction) use.friction = std::max(use.friction, size(6, i) / *limits.friction);
  }
  return use;
}

}  // namespace bbsim::design
