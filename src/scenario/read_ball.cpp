// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `ball` and `plate`: sizes, masses, losses, pushes, the start.
#include "base/number_text.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {

namespace {

void read_losses(yaml::Keys& keys, Losses& losses) {
  keys.optional("rolling",
                yaml::Number{yaml::Dimension::number, {.at_least = 0, .at_most = 1}, "0.002"},
                losses.rolling, {"coefficient of rolling resistance"});
  keys.optional("viscous", yaml::Number{yaml::Dimension::number, {.at_least = 0}, "2e-6"},
                losses.viscous,
                {"couple divided by the rate of turn about an axis in the plate", "N m s"});
  keys.optional("pivoting", yaml::Number{yaml::Dimension::length, {.at_least = 0}, "1e-4"},
                losses.pivoting, {"couple about the normal, divided by the normal force"});
}

void read_push(yaml::Keys& keys, BallPush& push) {
  keys.optional("x", ProfileRule{yaml::Dimension::force}, push.x,
                {"[profiles](#profiles): a force on the ball's center, along the plate's axes"});
  keys.optional("y", ProfileRule{yaml::Dimension::force}, push.y, yaml::same);
}

}  // namespace

void read_ball(yaml::Keys& keys, Ball& ball) {
  const yaml::Number length{yaml::Dimension::length, {.above = 0}};
  keys.required("radius", yaml::Usual{length, "mm", 1}, ball.radius, {"radius"});
  const yaml::Number mass{yaml::Dimension::mass, {.above = 0}};
  keys.optional(
      "mass", yaml::Usual{mass, "g", 20}, ball.mass,
      {"mass; changes forces, torques and energy, and the motion only where noted below"});
  keys.optional("position", yaml::PairOf{yaml::Dimension::length}, ball.position,
                {"contact point (x, y) at t = 0"});
  keys.optional("velocity", yaml::PairOf{yaml::Dimension::velocity}, ball.velocity,
                {"its velocity in the plate frame, (x', y')"});
  keys.optional("spin", yaml::Number{yaml::Dimension::angular_rate}, ball.spin,
                {"rate of turn about the plate's normal, γ'"});
  // The factor is 0 with all mass at the center, and 2/3 with all mass at the surface.
  const yaml::Number factor{yaml::Dimension::number, {.at_least = 0, .at_most = 0.67}, "0.4"};
  keys.optional("inertia_factor", factor, ball.inertia_factor,
                {"moment of inertia over m r²: 0 for all mass at the center, 2/5 for a solid ball, "
                 "2/3 for a thin shell"});
  std::optional<double> rolling;
  keys.optional("rolling_radius", yaml::Usual{length, "mm", 1}, rolling,
                {.meaning = "of a ball in a groove or between rails: distance from its center to "
                            "the axis through its two contacts; only in scenarios along one axis",
                 .range = "> 0, ≤ `ball.radius`"});
  if (rolling && *rolling > ball.radius && ball.radius > 0) {
    keys.find("rolling_radius")
        ->refuse("", "a length of at most ball.radius, " + number_text(ball.radius) + " m");
  } else if (rolling && *rolling > 0) {
    // The ball acts like one of the rolling radius with the inertia of the whole ball.
    const double ratio = ball.radius / *rolling;
    ball.groove = Groove{ball.radius};
    ball.inertia_factor *= ratio * ratio;
    ball.radius = *rolling;
  }
  keys.section("losses", read_losses, ball.losses);
  keys.optional(
      "rotation", yaml::PairOf{yaml::Dimension::angular_rate}, ball.rotation,
      {.meaning =
           "$[\\omega_x, \\omega_y]$ at t = 0, relative to the plate, about its x and y axes",
       .standard = "from rolling"});
  static_cast<void>(keys.find("push", yaml::MappingOf(read_push)));  // read_ball_push() reads it
}

void read_ball_push(yaml::Keys& scenario, Ball& ball) {
  const auto keys = scenario.find("ball");
  if (!keys || keys->node->kind != yaml::Node::Kind::mapping) return;
  yaml::Keys(*keys).optional("push", yaml::MappingOf(read_push), ball.push);
}

void read_plate(yaml::Keys& keys, Plate& plate) {
  const yaml::ArrayOf<3> moments{
      {yaml::Dimension::number, {.at_least = 0}, "2e-4"},
      "three moments of inertia about x, y and the normal, such as [2e-4, 2e-4, 4e-4]"};
  keys.exclusive({{"size"}, {"diameter"}});
  keys.optional("size", yaml::sides, plate.size,
                {"[a, b], sides along x and y of a rectangle about the plate's origin"});
  const yaml::Number diameter{yaml::Dimension::length, {.above = 0}};
  if (keys.optional("diameter", diameter, plate.diameter,
                    {"diameter of a disc about the plate's origin, instead of `size`"}) &&
      plate.diameter && plate.size) {
    keys.find("diameter")->report("given together with size; allowed: one of them");
  }
  keys.optional(
      "inertia", moments, plate.inertia,
      {"$[J_x, J_y, J_n]$ about the gimbal's center, along the plate's x axis, y axis and normal",
       "kg m²"});
  keys.optional("mass", yaml::Number{yaml::Dimension::mass, {.at_least = 0}}, plate.mass,
                {"mass of the plate"});
  keys.optional(
      "center_of_mass", yaml::Number{yaml::Dimension::length}, plate.centre_of_mass,
      {"height of its center of mass above the gimbal's center, along the normal; negative below"});
}

}  // namespace bbsim::scenario
