// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/independent.hpp"

#include <charconv>
#include <optional>
#include <span>
#include <variant>

#include "scenario/coupled.hpp"

namespace bbsim {
namespace {

using Names = std::span<const std::string_view>;
using Numbers = std::vector<double*>;

std::optional<std::size_t> index(std::string_view name, std::size_t size) {
  std::size_t number = 0;
  const auto result = std::from_chars(name.data(), name.data() + name.size(), number);
  if (result.ec != std::errc{} || result.ptr != name.data() + name.size() || number >= size) {
    return {};
  }
  return number;
}

Numbers in_pair(Pair& pair, Names names) {
  const auto i = names.size() == 1 ? index(names[0], 2) : std::nullopt;
  if (!i) return {};
  return {&pair[*i]};
}

Numbers in_matrix(Matrix2& matrix, Names names) {
  if (names.empty()) return {&matrix[0][0], &matrix[1][1]};
  const auto row = index(names[0], 2);
  return row ? in_pair(matrix[*row], names.subspan(1)) : Numbers{};
}

Numbers in_ball(Ball& ball, Names names) {
  if (names[0] == "position") return in_pair(ball.position, names.subspan(1));
  if (names[0] == "velocity") return in_pair(ball.velocity, names.subspan(1));
  if (names.size() != 1) return {};
  if (names[0] == "radius") return {&ball.radius};
  if (names[0] == "mass") return {&ball.mass};
  if (names[0] == "spin") return {&ball.spin};
  return {};
}

Numbers in_profile(Profile& profile, Names names) {
  std::size_t term = 0;
  if (!names.empty()) {
    if (const auto i = index(names[0], profile.size())) {
      term = *i;
      names = names.subspan(1);
    } else if (profile.size() != 1) {
      return {};
    }
  }
  if (term >= profile.size()) return {};
  if (auto* const constant = std::get_if<double>(&profile[term])) {
    return names.empty() ? Numbers{constant} : Numbers{};
  }
  if (names.size() != 2) return {};
  if (auto* const sinusoid = std::get_if<Sinusoid>(&profile[term]); sinusoid != nullptr) {
    if (names[0] != "sinusoid") return {};
    if (names[1] == "amplitude") return {&sinusoid->amplitude};
    if (names[1] == "frequency") return {&sinusoid->frequency};
    if (names[1] == "phase") return {&sinusoid->phase};
    if (names[1] == "offset") return {&sinusoid->offset};
  }
  if (auto* const ramp = std::get_if<Ramp>(&profile[term]); ramp != nullptr) {
    if (names[0] != "ramp") return {};
    if (names[1] == "start") return {&ramp->start};
    if (names[1] == "rate") return {&ramp->rate};
  }
  return {};
}

Numbers in_gimbal(Gimbal& gimbal, Names names) {
  if (names.size() < 2) return {};
  if (names[0] == "motion" && gimbal.motion) {
    Profile* const profile = names[1] == "phi"     ? &gimbal.motion->phi
                             : names[1] == "theta" ? &gimbal.motion->theta
                                                   : nullptr;
    return profile == nullptr ? Numbers{} : in_profile(*profile, names.subspan(2));
  }
  if (names.size() != 2) return {};
  if (names[0] == "start") {
    if (names[1] == "phi") return {&gimbal.start.phi};
    if (names[1] == "theta") return {&gimbal.start.theta};
    if (names[1] == "phi_rate") return {&gimbal.start.phi_rate};
    if (names[1] == "theta_rate") return {&gimbal.start.theta_rate};
  }
  if (names[0] == "servo" && gimbal.servo) {
    if (names[1] == "natural_frequency") return {&gimbal.servo->natural_frequency};
    if (names[1] == "damping") return {&gimbal.servo->damping};
  }
  return {};
}

Numbers in_controller(Controller& controller, Names names) {
  if (names.size() < 2) return {};
  if (names[0] == "pd") {
    // The reader refuses a number that drives angles.
    if (names.size() == 2 && controller.drives == Drives::angle) return {};
    if (names[1] == "kv") return in_matrix(controller.kv, names.subspan(2));
    if (names[1] == "kp") return in_matrix(controller.kp, names.subspan(2));
  }
  if (names[0] != "reference") return {};
  auto* const point = std::get_if<PointReference>(&controller.reference);
  if (point != nullptr && names[1] == "point") return in_pair(point->position, names.subspan(2));
  auto* const circle = std::get_if<CircleReference>(&controller.reference);
  if (circle == nullptr || names[1] != "circle" || names.size() < 3) return {};
  if (names[2] == "center" || names[2] == "centre")
    return in_pair(circle->centre, names.subspan(3));
  if (names.size() != 3) return {};
  if (names[2] == "radius") return {&circle->radius};
  if (names[2] == "rate") return {&circle->rate};
  if (names[2] == "phase") return {&circle->phase};
  return {};
}

// Whether the scene has no events, and prescribed motion or equation (31) with a plain servo.
bool is_plain(const Scenario& scenario) {
  if (bbsim::scenario::is_coupled(scenario) || scenario.ball.groove) return false;
  const Events& events = scenario.events;
  if (events.edge || events.slip || events.lift_off || events.tilt || events.singularity) {
    return false;
  }
  if (!scenario.controller) return true;
  const Gimbal& gimbal = scenario.gimbal;
  if (gimbal.linkage[0] || gimbal.linkage[1] || gimbal.three_servos || gimbal.theta_servo) {
    return false;
  }
  const Controller& controller = *scenario.controller;
  return controller.law == Law::pd && !controller.limit && !controller.axis_limits &&
         !controller.sampling && (!gimbal.servo || gimbal.servo->plain());
}

}  // namespace

std::vector<double*> independent_number(Scenario& scenario, std::string_view key) {
  if (!is_plain(scenario)) return {};
  if (key == "gravity") return {&scenario.gravity};
  std::vector<std::string_view> names;
  for (std::size_t dot = 0; dot != std::string_view::npos;) {
    dot = key.find('.');
    names.push_back(key.substr(0, dot));
    if (dot != std::string_view::npos) key.remove_prefix(dot + 1);
  }
  if (names.size() < 2) return {};
  const Names rest = Names(names).subspan(1);
  if (names[0] == "ball") return in_ball(scenario.ball, rest);
  if (names[0] == "gimbal") return in_gimbal(scenario.gimbal, rest);
  if (names[0] == "controller" && scenario.controller) {
    return in_controller(*scenario.controller, rest);
  }
  return {};
}

}  // namespace bbsim
