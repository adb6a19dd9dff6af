// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `ball` and `plate`: sizes, masses, losses, pushes, the start.
#include "base/number_text.hpp"
#include "scenario/profile.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {

namespace {

void read_losses(yaml::Keys& keys, Losses& losses) {
  keys.optional("rolling",
                yaml::Number{yaml::Dimension::number, {.at_least = 0, .at_most = 1}, "0.002"},
                losses.rolling);
  keys.optional("viscous", yaml::Number{yaml::Dimension::number, {.at_least = 0}, "2e-6"},
                losses.viscous);
  keys.optional("pivoting", yaml::Number{yaml::Dimension::length, {.at_least = 0}, "1e-4"},
                losses.pivoting);
}

void read_push(yaml::Keys& keys, BallPush& push) {
  keys.optional("x", ProfileRule{ProfileOf::force}, push.x);
  keys.optional("y", ProfileRule{ProfileOf::force}, push.y);
}

}  // namespace

void read_ball(yaml::Keys& keys, Ball& ball) {
  const yaml::Number length{yaml::Dimension::length, {.above = 0}};
  keys.required("radius", yaml::Usual{length, "mm", 1}, ball.radius);
  const yaml::Number mass{yaml::Dimension::mass, {.above = 0}};
  keys.optional("mass", yaml::Usual{mass, "g", 20}, ball.mass);
  keys.optional("position", yaml::PairOf{yaml::Dimension::length}, ball.position);
  keys.optional("velocity", yaml::PairOf{yaml::Dimension::velocity}, ball.velocity);
  keys.optional("spin", yaml::Number{yaml::Dimension::angular_rate}, ball.spin);
  // The factor is 0 with all mass at the center, and 2/3 with all mass at the surface.
  const yaml::Number factor{yaml::Dimension::number, {.at_least = 0, .at_most = 0.67}, "0.4"};
  keys.optional("inertia_factor", factor, ball.inertia_factor);
  std::optional<double> rolling;
  keys.optional("rolling_radius", yaml::Usual{length, "mm", 1}, rolling);
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
  keys.optional("rotation", yaml::PairOf{yaml::Dimension::angular_rate}, ball.rotation);
  static_cast<void>(keys.find("push", yaml::MappingOf(read_push)));  // read_ball_push() reads it
}

void read_ball_push(yaml::Keys& scenario, Ball& ball) {
  const auto keys = scenario.find("ball");
  if (!keys || keys->node->kind != yaml::Node::Kind::mapping) return;
  yaml::Keys(*keys).optional("push", yaml::MappingOf(read_push), ball.push);
}

void read_plate(yaml::Keys& keys, Plate& plate) {
  keys.exclusive({{"size"}, {"diameter"}});
  keys.optional("size", yaml::SidesOf{}, plate.size);
  const yaml::Number diameter{yaml::Dimension::length, {.above = 0}};
  if (keys.optional("diameter", diameter, plate.diameter) && plate.diameter && plate.size) {
    keys.find("diameter")->report("given together with size; allowed: one of them");
  }
  keys.optional("inertia", yaml::MomentsOf{}, plate.inertia);
  keys.optional("mass", yaml::Number{yaml::Dimension::mass, {.at_least = 0}}, plate.mass);
  keys.optional("center_of_mass", yaml::Number{yaml::Dimension::length}, plate.centre_of_mass);
}

}  // namespace bbsim::scenario
