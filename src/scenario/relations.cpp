// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/relations.hpp"

#include <algorithm>
#include <optional>

namespace bbsim::scenario {
namespace {

constexpr auto needs = KeyRelation::Kind::needs;
constexpr auto excludes = KeyRelation::Kind::excludes;

constexpr KeyRelation table[] = {
    // What moves the gimbal.
    {"time", needs, "gimbal.motion or gimbal.torque or controller"},
    {"gimbal.motion", excludes, "gimbal.torque or controller"},
    {"gimbal.torque", excludes, "controller"},
    {"gimbal.start", excludes, "gimbal.motion",
     "found beside gimbal.motion, which determines where the gimbal starts; allowed: only with a "
     "controller"},
    {"gimbal.servo", excludes, "gimbal.motion",
     "found beside gimbal.motion, which no servo follows; allowed: only with a controller that "
     "drives angle, such as controller.commands, which plays known commands"},
    {"gimbal.motor", excludes, "gimbal.motion",
     "found beside gimbal.motion, which no torque changes; allowed: only with gimbal.torque or a "
     "controller"},
    {"gimbal.servo", excludes, "gimbal.torque",
     "found beside gimbal.torque, which no servo follows; allowed: only with a controller that "
     "drives angle"},
    {"gimbal.motor.position_loop", excludes, "gimbal.torque",
     "found beside gimbal.torque, which prescribes the motors' torque; allowed: only with a "
     "controller that drives angle"},
    {"controller.drives=angle", needs, "gimbal.servo or gimbal.motor.position_loop"},
    {"controller.drives=angle", excludes, "gimbal.servo and gimbal.motor"},
    {"gimbal.servo", excludes, "controller and controller.drives=acceleration|",
     "found, but controller.drives is acceleration, which no servo follows; allowed: only with "
     "drives: angle"},
    {"gimbal.motor", excludes, "controller and controller.drives=acceleration|",
     "found, but controller.drives is acceleration, whatever the torque; allowed: only with "
     "drives: torque or voltage, or angle and a position_loop"},
    {"gimbal.servo", excludes, "controller.drives=torque",
     "found, but controller.drives is torque, which no servo follows; allowed: only with drives: "
     "angle"},
    {"gimbal.motor.position_loop", excludes, "controller.drives=torque",
     "found, but controller.drives is torque; allowed: only with drives: angle, which the loop "
     "follows"},
    {"gimbal.servo", excludes, "controller.drives=voltage",
     "found, but controller.drives is voltage, which no servo follows; allowed: only with drives: "
     "angle"},
    {"gimbal.motor.position_loop", excludes, "controller.drives=voltage",
     "found, but controller.drives is voltage; allowed: only with drives: angle, which the loop "
     "follows"},
    {"controller.drives=voltage", needs, "gimbal.motor.dc"},

    // Servos and linkages.
    {"gimbal.servo", needs,
     "gimbal.servo.model or gimbal.servo.time_constant or gimbal.servo.stepper or "
     "gimbal.servo.natural_frequency and "
     "gimbal.servo.damping or "
     "gimbal.servo.phi and gimbal.servo.theta"},
    {"gimbal.servo.time_constant", needs, "controller.sampling"},
    {"gimbal.servo.time_constant", excludes, "gimbal.servo.acceleration_limit"},
    {"gimbal.servo.stepper", needs, "controller.sampling"},
    {"gimbal.servo.stepper", needs,
     "gimbal.servo.acceleration_limit and gimbal.servo.rate_limit or "
     "gimbal.servo.acceleration_limit and gimbal.servo.speed or controller.library.wiring"},
    {"gimbal.servo.stepper", excludes,
     "controller.library.wiring and gimbal.servo.rate_limit or "
     "controller.library.wiring and gimbal.servo.speed or "
     "controller.library.wiring and gimbal.servo.acceleration_limit"},
    {"gimbal.servo.stepper.torque", needs,
     "gimbal.servo.stepper.inertia or gimbal.servo.stepper.model"},
    {"gimbal.servo.stepper.inertia", needs,
     "gimbal.servo.stepper.torque or gimbal.servo.stepper.model"},
    {"gimbal.servo.stepper.corner_speed", needs,
     "gimbal.servo.stepper.torque or gimbal.servo.stepper.model"},
    {"gimbal.servo.stepper.model", excludes,
     "gimbal.servo.backlash>0 or controller.library.wiring"},
    {"gimbal.servo.stepper.damping", needs, "gimbal.servo.stepper.natural_frequency"},
    {"gimbal.servo.stepper.natural_frequency", excludes, "gimbal.servo.backlash>0"},
    {"gimbal.servo.stepper.torque", excludes,
     "gimbal.servo.backlash>0 or controller.library.wiring"},
    {"events.steps_lost", needs, "gimbal.servo.stepper.torque or gimbal.servo.stepper.model"},
    {"gimbal.servo.stepper", excludes, "gimbal.servo.angle_limit or gimbal.servo.model"},
    {"gimbal.servo.dead_band>0", needs, "controller.sampling"},
    {"controller.assumes", needs, "gimbal.linkage or gimbal.three_servos",
     "found, but nothing links servos and plate; allowed: only with gimbal.linkage or "
     "gimbal.three_servos"},
    {"controller.assumes", excludes,
     "controller.drives=legs or gimbal.linkage and controller.program or gimbal.linkage and "
     "controller.library"},
    {"gimbal.three_servos", excludes, "gimbal.linkage",
     "found beside gimbal.linkage; allowed: one of the two, since three servos are a linkage "
     "themselves"},
    {"gimbal.linkage", needs, "controller.drives=angle"},
    {"gimbal.linkage", excludes, "gimbal.motor"},
    {"gimbal.three_servos", needs, "controller.drives=angle|legs"},
    {"gimbal.three_servos", needs,
     "gimbal.three_servos.legs or gimbal.three_servos.radius_base and "
     "gimbal.three_servos.radius_plate and gimbal.three_servos.horn and gimbal.three_servos.rod "
     "and "
     "gimbal.three_servos.height"},
    {"gimbal.three_servos", excludes, "gimbal.motor or gimbal.servo.phi or gimbal.servo.theta"},
    {"controller.drives=legs", needs,
     "gimbal.three_servos and gimbal.servo and controller.program or gimbal.three_servos and "
     "gimbal.servo and controller.library"},
    {"controller.drives=legs", excludes, "controller.limit.phi or controller.limit.theta"},

    // Ball, plate and torques.
    {"ball.push", needs, "ball.mass",
     "found, but no ball.mass, and a push moves a lighter ball farther; allowed: only with "
     "ball.mass"},
    {"ball.push", excludes, "controller.feedback_linearization"},
    {"ball.losses.viscous>0", needs, "ball.mass"},
    {"ball.losses.rolling>0", excludes, "controller.feedback_linearization"},
    {"ball.losses.pivoting>0", excludes, "controller.feedback_linearization"},
    {"ball.rolling_radius", excludes, "events.slip or gimbal.three_servos or ball.rotation"},
    {"ball.rotation", needs, "events.slip.action=slide",
     "found, but the ball only rolls, which determines how it turns; allowed: only with "
     "events.slip and its action: slide"},
    {"plate.center_of_mass", needs, "plate.mass>0"},
    {"gimbal.torque", needs, "ball.mass and plate.inertia"},
    {"gimbal.motor", needs, "ball.mass and plate.inertia"},
    {"controller.drives=torque|voltage", needs, "ball.mass and plate.inertia"},
    {"gimbal.ring_inertia", needs,
     "gimbal.torque or gimbal.motor or controller.drives=torque|voltage"},

    // The controller.
    {"controller", needs, "controller.reference or controller.commands"},
    {"controller.reference", excludes, "controller.commands"},
    {"controller.commands", needs, "controller.drives=angle"},
    {"controller.sensor", excludes, "controller.commands",
     "found beside commands, which no measurement changes; allowed: without it"},
    {"controller.program", needs, "controller.sampling"},
    {"controller.library", needs, "controller.sampling"},
    {"controller.library.serial", needs, "controller.library.wiring",
     "found without wiring; allowed: only with it, since the line is that of a sketch's board"},
    {"controller.feedback_linearization", excludes, "controller.sampling"},
    {"controller.feedback_linearization", needs, "controller.drives=acceleration|"},
    {"controller.gravity_compensation", needs, "controller.drives=angle"},
    {"controller.sampling.resolution>0", needs, "controller.drives=angle|legs"},
    {"controller.sensor", needs, "controller.sampling",
     "found, but no controller.sampling; allowed: only with it, since the controller reads the "
     "sensor at its samples; a continuous law knows the ball exactly"},
    {"controller.sensor.seed", needs,
     "controller.sensor.noise or controller.sensor.dropout or controller.sensor.stuck or "
     "controller.sensor.burst or controller.sampling.jitter or controller.library.wiring",
     "found, but nothing here is random; allowed: only with sensor.noise, .dropout, .stuck or "
     ".burst, with sampling.jitter, or a sketch"},
    {"controller.sensor.burst", needs, "controller.sensor.period",
     "found without sensor.period; allowed: only with it, since it holds up a camera's frames"},
    {"controller.sensor.contact_force>0", needs, "ball.mass",
     "found, but no ball.mass, and a lighter ball presses less; allowed: only with ball.mass"},
    {"controller.sensor.on_miss=edge", needs, "controller.sensor.area",
     "found without sensor.area; allowed: only with it, whose corner it reads"},
    {"controller.sensor.phase", needs, "controller.sensor.period",
     "found without sensor.period; allowed: only with it, since a sensor without frames measures "
     "at the controller's samples"},

    // Events.
    {"events.edge", needs, "plate.size or plate.diameter",
     "found, but the plate has no edge; allowed: only with plate.size or plate.diameter"},
    {"events.rest", needs, "ball.losses.rolling>0"},
    {"events.stick", needs, "gimbal.motor.friction>0"},
    {"events.singularity", needs, "controller.feedback_linearization"},
    {"events.slip.action=slide", needs, "events.slip.sliding_friction"},
    {"events.slip.sliding_friction", needs, "events.slip.action=slide"},
    {"events.slip.action=slide", excludes,
     "controller.feedback_linearization or gimbal.servo.time_constant or gimbal.servo.angle_limit "
     "or gimbal.servo.backlash>0"},
};

std::vector<std::string_view> split(std::string_view text, std::string_view by) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(by); end != std::string_view::npos; end = text.find(by)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + by.size());
  }
  parts.push_back(text);
  return parts;
}

std::optional<yaml::Value> find_at(yaml::Keys& keys, std::string_view path) {
  std::optional<yaml::Value> value = keys.mapping();
  for (const std::string_view key : split(path, ".")) {
    if (value) value = yaml::Keys(*value).find(key);
  }
  return value;
}

// Ignores Condition::positive, because no relation with a message uses it.
bool holds(yaml::Keys& keys, const Condition& condition) {
  const std::optional<yaml::Value> value = find_at(keys, condition.path);
  if (!value) return condition.or_absent;
  return condition.values.empty() ||
         std::ranges::find(condition.values, value->node->text) != condition.values.end();
}

struct Check {
  const KeyRelation* relation;
  Condition key;
  std::vector<std::vector<Condition>> others;
};

const std::vector<Check>& checks() {
  static const std::vector<Check> all = [] {
    std::vector<Check> list;
    for (const KeyRelation& one : table) {
      if (!one.message.empty()) list.push_back({&one, Condition(one.key), one.alternatives()});
    }
    return list;
  }();
  return all;
}

void report_if_broken(yaml::Keys& keys, const Check& check) {
  if (!holds(keys, check.key)) return;
  const bool any = std::ranges::any_of(check.others, [&](const auto& alternative) {
    return std::ranges::all_of(alternative,
                               [&](const Condition& condition) { return holds(keys, condition); });
  });
  if (any == (check.relation->kind == needs)) return;
  const yaml::Value value = *find_at(keys, check.key.path);
  value.context->problems.add(value.position,
                              value.path + ": " + std::string(check.relation->message));
}

// Whether the relation is about what moves the gimbal. check_loop() asks for these one by one.
bool of_loop(const KeyRelation& relation) {
  return relation.others == "gimbal.motion" || relation.others == "gimbal.torque" ||
         relation.others.find("controller.drives") != std::string_view::npos;
}

}  // namespace

Condition::Condition(std::string_view text) {
  if (text.ends_with(">0")) {
    positive = true;
    text.remove_suffix(2);
  }
  const std::size_t equals = text.find('=');
  path = text.substr(0, equals);
  if (equals == std::string_view::npos) return;
  values = split(text.substr(equals + 1), "|");
  or_absent = std::erase(values, "") > 0;
}

std::vector<std::vector<Condition>> KeyRelation::alternatives() const {
  std::vector<std::vector<Condition>> all;
  for (const std::string_view alternative : split(others, " or ")) {
    auto& one = all.emplace_back();
    for (const std::string_view condition : split(alternative, " and ")) {
      one.emplace_back(condition);
    }
  }
  return all;
}

std::span<const KeyRelation> relations() {
  return table;
}

void check_relations(yaml::Keys& scenario, std::string_view others) {
  for (const Check& check : checks()) {
    if (check.relation->others == others) report_if_broken(scenario, check);
  }
}

void check_relations(yaml::Keys& scenario) {
  for (const Check& check : checks()) {
    if (!of_loop(*check.relation)) report_if_broken(scenario, check);
  }
}

}  // namespace bbsim::scenario
