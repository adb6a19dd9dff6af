// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A ball in a groove or between rails, which rolls along one axis.
#include <algorithm>

#include "scenario/sections.hpp"

namespace bbsim::scenario {
namespace {

bool is_zero(const Profile& profile) {
  return std::ranges::all_of(profile, [](const ProfileTerm& term) {
    const auto* constant = std::get_if<double>(&term);
    return constant != nullptr && *constant == 0;
  });
}

// Whether a reference stays at 0 along a coordinate.
struct StaysAtZero {
  std::size_t i;

  [[nodiscard]] bool are_zero(const std::vector<Pair>& points) const {
    return std::ranges::all_of(points, [this](const Pair& point) { return point[i] == 0; });
  }

  bool operator()(const PointReference& of) const { return of.position[i] == 0; }
  bool operator()(const CircleReference& of) const { return of.radius == 0 && of.centre[i] == 0; }
  bool operator()(const LissajousReference& of) const {
    return of.amplitude[i] == 0 && of.centre[i] == 0;
  }
  bool operator()(const WaypointReference& of) const { return are_zero(of.points); }
  bool operator()(const CommandProfiles& of) const { return is_zero(i == 0 ? of.phi : of.theta); }
  bool operator()(const TableReference& of) const {
    return std::ranges::all_of(i == 0 ? of.x : of.y, [](double value) { return value == 0; });
  }
  bool operator()(const StaircaseReference& of) const { return are_zero(of.points); }
  bool operator()(const SquareReference& of) const {
    return of.amplitude[i] == 0 && of.centre[i] == 0;
  }
};

// Whether a continuous law also moves the other axis.
bool couples(const Controller& controller, std::size_t own) {
  const std::size_t across = 1 - own;
  const auto& gain = controller.gain[across];
  return controller.kp[across][own] != 0 || controller.kv[across][own] != 0 ||
         controller.ki[across][own] != 0 || gain[own] != 0 || gain[2 + own] != 0 ||
         gain[4 + own] != 0 || gain[6 + own] != 0;
}

}  // namespace

std::string why_not_along(int axis, const Scenario& scene) {
  const auto own = static_cast<std::size_t>(axis), across = 1 - own;
  const bool x = axis == 0;  // phi moves the ball along x, theta along y
  const Ball& ball = scene.ball;
  if (ball.position[across] != 0) return "ball.position is not 0 across it";
  if (ball.velocity[across] != 0) return "ball.velocity is not 0 across it";
  if (ball.spin != 0) return "ball.spin is not 0";
  if (ball.push && !is_zero(x ? ball.push->y : ball.push->x)) return "ball.push acts across it";
  const Gimbal& gimbal = scene.gimbal;
  const char* const tilts = x ? "theta tilts the plate" : "phi tilts the plate";
  for (const auto& given : {gimbal.motion, gimbal.torque}) {
    if (given && !is_zero(x ? given->theta : given->phi)) return tilts;
  }
  const GimbalStart& start = gimbal.start;
  if ((x ? start.theta : start.phi) != 0 || (x ? start.theta_rate : start.phi_rate) != 0) {
    return tilts;
  }
  const Mounting& mounting = gimbal.mounting;
  if ((x ? mounting.theta_offset : mounting.phi_offset) != 0 || mounting.skew != 0 ||
      mounting.yaw != 0 || mounting.base_tilt != 0) {
    return "gimbal.mounting tilts or turns the plate";
  }
  if (!scene.controller) return "";
  if (!std::visit(StaysAtZero{across}, scene.controller->reference)) {
    return "controller.reference is not 0 across it";
  }
  // A sampled controller's other command is left out.
  if (!scene.controller->sampling && couples(*scene.controller, own)) {
    return "the law's gains move both axes";
  }
  return "";
}

void place_groove(Scenario& scene) {
  if (!scene.ball.groove) return;
  scene.ball.groove->axis = why_not_along(0, scene).empty() ? 0 : 1;
  if (scene.controller && scene.controller->sensor) {
    scene.controller->sensor->only = scene.ball.groove->axis;
  }
}

}  // namespace bbsim::scenario
