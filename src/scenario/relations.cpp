// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/relations.hpp"

#include <algorithm>

#include "base/text.hpp"

namespace bbsim::scenario {
namespace {

constexpr auto needs = KeyRelation::Kind::needs;
constexpr auto excludes = KeyRelation::Kind::excludes;

constexpr KeyRelation movers[] = {
    {"controller", excludes, "gimbal.motion",
     "found beside gimbal.motion; allowed: exactly one of the two, since either the scenario "
     "prescribes the motion or the controller drives it"},
    {"gimbal.torque", excludes, "gimbal.motion",
     "found beside gimbal.motion; allowed: exactly one of gimbal.motion, gimbal.torque and "
     "controller"},
    {"gimbal.torque", excludes, "controller",
     "found beside controller; allowed: exactly one of gimbal.motion, gimbal.torque and "
     "controller"},
    {"", needs, "gimbal.motion or gimbal.torque or controller",
     "missing, and so is controller; allowed: exactly one of the two", "gimbal:gimbal.motion"},
};

constexpr KeyRelation moved[] = {
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
    {"controller.drives=angle", needs, "gimbal.servo or gimbal.motor",
     "missing, but controller.drives is angle; allowed: a mapping with natural_frequency, damping",
     "gimbal:gimbal.servo"},
    {"controller.drives=legs", needs, "gimbal.servo",
     "missing, but controller.drives is legs; allowed: a mapping with natural_frequency, damping",
     "gimbal:gimbal.servo"},
    {"gimbal.motor and controller.drives=angle", needs,
     "gimbal.servo or gimbal.motor.position_loop",
     "found without position_loop, but controller.drives is angle; allowed: a position_loop that "
     "follows the angle, or drives: torque or voltage"},
    {"gimbal.servo and controller.drives=angle", excludes, "gimbal.motor",
     "found beside gimbal.motor, but a servo moves at any torque; allowed: one of the two"},
    {"gimbal.servo", excludes, "controller and controller.drives=acceleration|",
     "found, but controller.drives is acceleration, which no servo follows; allowed: only with "
     "drives: angle"},
    {"gimbal.motor", excludes, "controller and controller.drives=acceleration|",
     "found, but controller.drives is acceleration, whatever the torque; allowed: only with "
     "drives: torque or voltage, or angle and a position_loop"},
    {"gimbal.servo", excludes, "controller.drives=torque|voltage",
     "found, but controller.drives is {=controller.drives}, which no servo follows; allowed: only "
     "with drives: angle"},
    {"gimbal.motor.position_loop", excludes, "controller.drives=torque|voltage",
     "found, but controller.drives is {=controller.drives}; allowed: only with drives: angle, "
     "which the loop follows"},
    {"controller.drives=voltage", needs, "gimbal.motor.dc",
     "missing, but controller.drives is voltage; allowed: a mapping with resistance, "
     "torque_constant",
     "gimbal:gimbal.motor.dc"},
};

constexpr std::string_view by_torques =
    "gimbal.torque or controller.drives=torque|voltage or "
    "controller.drives=angle and gimbal.motor.position_loop";

constexpr std::string_view one_of_torque_and_inertia =
    "found with one of torque and inertia; allowed: both, whose ratio is the greatest "
    "acceleration, or neither";

constexpr KeyRelation others[] = {
    // Servos.
    {"gimbal.servo.time_constant", needs, "controller.sampling",
     "found without controller.sampling; allowed: only with it. The rate of a servo of first order "
     "follows its command at once, so a continuous command would have to be differentiated"},
    {"gimbal.servo.acceleration_limit", excludes, "gimbal.servo.time_constant",
     "found with time_constant: a servo of first order changes its rate at once; allowed: only "
     "with natural_frequency and damping"},
    {"gimbal.servo.dead_band>0", needs, "controller.sampling",
     "found without controller.sampling; allowed: only with it, since a dead band "
     "compares each command with the one before"},
    {"gimbal.servo.stepper", needs, "controller.sampling",
     "found without controller.sampling; allowed: only with it, since the driver plans a ramp to "
     "each command"},
    {"gimbal.servo.stepper.torque or gimbal.servo.stepper.model", excludes,
     "controller.library.wiring",
     "found with torque; allowed: only under a law of bbsim, whose ramps it limits. To test a "
     "sketch's ramp, give its speed and acceleration as rate_limit and acceleration_limit of such "
     "a law",
     "gimbal.servo.stepper"},
    {"gimbal.servo.stepper and controller.library.wiring", excludes,
     "gimbal.servo.rate_limit or gimbal.servo.speed or gimbal.servo.acceleration_limit",
     "found beside rate_limit or acceleration_limit; allowed: without them, since the sketch's "
     "pulses make the ramp"},
    {"gimbal.servo.stepper", needs,
     "gimbal.servo.acceleration_limit and gimbal.servo.rate_limit or "
     "gimbal.servo.acceleration_limit and gimbal.servo.speed or controller.library.wiring",
     "found without rate_limit and acceleration_limit; allowed: only with both, which are the "
     "driver's ramp"},
    {"gimbal.servo.stepper", excludes,
     "gimbal.servo.natural_frequency or gimbal.servo.time_constant or gimbal.servo.model",
     "found beside natural_frequency, time_constant or model; allowed: one of them"},
    {"gimbal.servo.stepper.torque", needs,
     "gimbal.servo.stepper.inertia or gimbal.servo.stepper.model", one_of_torque_and_inertia,
     "gimbal.servo.stepper"},
    {"gimbal.servo.stepper.inertia", needs,
     "gimbal.servo.stepper.torque or gimbal.servo.stepper.model", one_of_torque_and_inertia,
     "gimbal.servo.stepper"},
    {"gimbal.servo.stepper.corner_speed", needs,
     "gimbal.servo.stepper.torque or gimbal.servo.stepper.model",
     "found with corner_speed, but no torque; allowed: only with torque and inertia",
     "gimbal.servo.stepper"},
    {"gimbal.servo.stepper.torque or gimbal.servo.stepper.model", excludes,
     "gimbal.servo.backlash>0", "found with torque, beside backlash; allowed: one of the two",
     "gimbal.servo.stepper"},
    {"gimbal.servo.stepper.natural_frequency", excludes, "gimbal.servo.backlash>0",
     "found with natural_frequency, beside backlash; allowed: one of the two",
     "gimbal.servo.stepper"},
    {"gimbal.servo.stepper", excludes, "gimbal.servo.angle_limit",
     "found beside angle_limit; allowed: controller.limit, which keeps commands within bounds"},

    // Linkages.
    {"controller.assumes", needs, "gimbal.linkage or gimbal.three_servos",
     "found, but nothing links servos and plate; allowed: only with gimbal.linkage or "
     "gimbal.three_servos"},
    {"controller.assumes", excludes,
     "controller.drives=legs or gimbal.linkage and controller.program or gimbal.linkage and "
     "controller.library",
     "found with your own controller, which commands the servos itself; allowed: only with a "
     "built-in law, or, of three servos, under drives: angle"},
    {"controller.assumes.legs or controller.assumes.radius_base", needs,
     "gimbal.three_servos and controller.sampling",
     "found legs; allowed: only with gimbal.three_servos and controller.sampling, since only "
     "firmware assumes other legs",
     "controller.assumes"},
    {"gimbal.three_servos", excludes, "gimbal.linkage",
     "found beside gimbal.linkage; allowed: one of the two, since three servos are a linkage "
     "themselves"},
    {"gimbal.linkage or gimbal.three_servos", needs, "controller",
     "found without a controller, and no servo moves it; allowed: only with a controller that "
     "drives angle"},
    {"gimbal.linkage and controller", needs, "controller.drives=angle or gimbal.motor",
     "found, but controller.drives is not angle, and no servo moves it; allowed: only with "
     "drives: angle and gimbal.servo"},
    {"gimbal.three_servos and controller", needs, "controller.drives=angle|legs or gimbal.motor",
     "found, but controller.drives is not angle, and no servo moves it; allowed: only with "
     "drives: angle and gimbal.servo"},
    {"gimbal.linkage and controller or gimbal.three_servos and controller", excludes,
     "gimbal.motor",
     "found, but gimbal.motor moves the axes themselves; allowed: only with drives: angle and "
     "gimbal.servo"},
    {"gimbal.servo.phi or gimbal.servo.theta", excludes, "gimbal.three_servos",
     "found keys for phi and theta beside gimbal.three_servos, which belong to no axis; allowed: "
     "the same keys for all three",
     "gimbal.servo"},
    {"controller.drives=legs", needs, "gimbal.three_servos",
     "found legs, but there are no three servos; allowed: angle, or gimbal.three_servos given"},
    {"controller.drives=legs", needs, "controller.program or controller.library",
     "found legs beside a law that gives two angles; allowed: angle, or your own program or "
     "library, which gives an angle for each servo"},
    {"controller.limit.phi or controller.limit.theta", excludes, "controller.drives=legs",
     "found limits of phi and theta, but the commands are those of three servos; allowed: one "
     "angle for all",
     "controller.limit"},

    // Ball, plate and torques.
    {"ball.push", needs, "ball.mass",
     "found, but no ball.mass, and a push moves a lighter ball farther; allowed: only with "
     "ball.mass"},
    {"ball.push", excludes, "controller.feedback_linearization",
     "found beside {controller.feedback_linearization}, whose equations do not include it; "
     "allowed: any other law"},
    {"ball.losses.viscous>0", needs, "ball.mass",
     "found, but no ball.mass, and a lighter ball loses more speed; allowed: only with ball.mass"},
    {"ball.losses.rolling>0 or ball.losses.pivoting>0", excludes,
     "controller.feedback_linearization",
     "found dry friction beside {controller.feedback_linearization}, which inverts smooth "
     "equations; allowed: viscous, or any other law",
     "ball.losses"},
    {"ball.losses.pivoting>0", needs, "ball.inertia_factor>0|",
     "found, but ball.inertia_factor is 0: such a ball's spin would stop at once; allowed: a "
     "factor greater than 0"},
    {"ball.rolling_radius", excludes, "gimbal.three_servos",
     "found beside gimbal.three_servos, which tilt the plate in all directions; allowed: only for "
     "a ball that rolls along one axis, in a groove or between rails"},
    {"ball.rolling_radius", excludes, "ball.rotation",
     "found beside ball.rotation, which turns the ball by itself; allowed: only for a ball that "
     "rolls along one axis, in a groove or between rails"},
    {"ball.rotation", needs, "events.slip.action=slide",
     "found, but the ball only rolls, which determines how it turns; allowed: only with "
     "events.slip and its action: slide"},
    {"plate.center_of_mass", needs, "plate.mass>0",
     "found without plate.mass; allowed: only with it, since the weight acts there"},
    {by_torques, needs, "ball.mass",
     "found no mass, but the ball's weight moves the gimbal; allowed: ball.mass given, since the "
     "default of 1 kg is not a realistic ball",
     "ball"},
    {by_torques, needs, "plate.inertia",
     "missing, but torques move the gimbal; allowed: three moments of inertia about x, y and the "
     "normal, such as [2e-4, 2e-4, 4e-4]",
     "gimbal:plate.inertia"},
    {"gimbal.ring_inertia", needs, by_torques,
     "found, but no torques move the gimbal; allowed: only with gimbal.torque, or a controller of "
     "gimbal.motor"},

    // The controller.
    {"controller.commands", needs, "controller.drives=angle",
     "found, but controller.drives is not angle; allowed: only with drives: angle, since commands "
     "are angles"},
    {"controller.sensor", excludes, "controller.commands",
     "found beside commands, which no measurement changes; allowed: without it"},
    {"controller.program or controller.library", needs, "controller.sampling",
     "found without controller.sampling; allowed: only with it, since bbsim calls it once per "
     "sample"},
    {"controller.library.serial", needs, "controller.library.wiring",
     "found without wiring; allowed: only with it, since the line is that of a sketch's board"},
    {"controller.sampling", excludes, "controller.feedback_linearization",
     "found beside {controller.feedback_linearization}, which needs the exact state at all times; "
     "allowed: any other law"},
    {"controller.feedback_linearization", needs, "controller.drives=acceleration|",
     "found {=controller.drives}, but {controller.feedback_linearization} gives the gimbal's "
     "accelerations; allowed: acceleration",
     "controller.drives"},
    {"controller.gravity_compensation", needs, "controller.drives=angle",
     "found, but controller.drives is not angle; allowed: only with drives: angle, since it gives "
     "angles"},
    {"controller.gravity_compensation", needs, "gravity>0|",
     "found, but gravity is 0; allowed: gravity greater than 0"},
    {"controller.lqr", needs, "gravity>0|",
     "found, but gravity is 0, and a tilted plate does not move the ball; allowed: gravity greater "
     "than 0"},
    {"controller.lqr", excludes, "gimbal.servo.time_constant",
     "found with a servo of first order (time_constant); allowed: one with natural_frequency and "
     "damping, whose state the regulator feeds back"},
    {"gimbal.motor.position_loop.ki>0", excludes, "controller.lqr",
     "found beside lqr, which does not see the loop's integral; allowed: ki 0, or any other law"},
    {"controller.sampling.resolution>0", needs, "controller.drives=angle|legs",
     "found, but controller.drives is not angle; allowed: only with drives: angle"},
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
    {"controller.sensor.contact_force", needs, "ball.mass",
     "found, but no ball.mass, and a lighter ball presses less; allowed: only with ball.mass"},
    {"controller.sensor.on_miss=edge", needs, "controller.sensor.area",
     "found without sensor.area; allowed: only with it, whose corner it reads"},
    {"controller.sensor.phase", needs, "controller.sensor.period",
     "found without sensor.period; allowed: only with it, since a sensor without frames measures "
     "at the controller's samples"},

    // Events.
    {"events.edge", needs, "plate.size or plate.diameter",
     "found, but the plate has no edge; allowed: only with plate.size or plate.diameter"},
    {"events.rest", needs, "ball.losses.rolling>0",
     "found, but nothing brings the ball to rest; allowed: only with ball.losses.rolling"},
    {"events.stick", needs, "gimbal.motor.friction>0",
     "found, but nothing holds an axis; allowed: only with gimbal.motor.friction"},
    {"events.steps_lost", needs, "gimbal.servo.stepper.torque or gimbal.servo.stepper.model",
     "found, but no stepper loses steps; allowed: only with gimbal.servo.stepper.torque"},
    {"events.singularity", needs, "controller.feedback_linearization",
     "found without controller.feedback_linearization; allowed: only with it"},
    {"events.slip", excludes, "ball.rolling_radius",
     "found beside ball.rolling_radius, and the friction of two contacts is not that of one; "
     "allowed: any other event"},
    {"events.slip.action=slide", needs, "events.slip.sliding_friction",
     "missing; allowed: a number of at least 0, such as 0.25",
     "events.slip:events.slip.sliding_friction"},
    {"events.slip.sliding_friction", needs, "events.slip.action=slide",
     "found, but action is not slide; allowed: only with action: slide",
     "=events.slip.sliding_friction"},
    {"events.slip.action=slide", needs, "ball.inertia_factor>0|",
     "found slide, but ball.inertia_factor is 0: nothing would make such a ball slide; allowed: a "
     "factor greater than 0"},
    {"events.slip.action=slide", excludes, "controller.feedback_linearization",
     "found slide beside {controller.feedback_linearization}, which inverts the equations of a "
     "ball that rolls; allowed: stop or note, or any other law"},
    {"events.slip.action=slide", excludes,
     "gimbal.servo.time_constant or gimbal.servo.angle_limit or gimbal.servo.backlash>0",
     "found slide with a servo that jolts the plate (time_constant, angle_limit or backlash), "
     "where the sliding motion is not defined; allowed: stop or note"},
};

constexpr ServoKey servo_keys[] = {
    {"gimbal.servo.acceleration_limit",
     [](const Servo& s) { return s.acceleration_limit < unlimited; }},
    {"gimbal.servo.angle_limit", [](const Servo& s) { return s.angle_limit < unlimited; }},
    {"gimbal.servo.backlash", [](const Servo& s) { return s.backlash > 0; }},
    {"gimbal.servo.dead_band", [](const Servo& s) { return s.dead_band > 0; }},
    {"gimbal.servo.model", [](const Servo& /*its values*/) { return false; }},
    {"gimbal.servo.natural_frequency", [](const Servo& s) { return s.natural_frequency > 0; }},
    {"gimbal.servo.rate_limit", [](const Servo& s) { return s.rate_limit < unlimited; }},
    {"gimbal.servo.stepper", [](const Servo& s) { return s.stepper.has_value(); }},
    {"gimbal.servo.stepper.corner_speed",
     [](const Servo& s) { return s.stepper && s.stepper->corner_speed; }},
    {"gimbal.servo.stepper.inertia",
     [](const Servo& s) { return s.stepper && s.stepper->inertia; }},
    {"gimbal.servo.stepper.model", [](const Servo& /*its values*/) { return false; }},
    {"gimbal.servo.stepper.natural_frequency",
     [](const Servo& s) { return s.stepper && s.stepper->natural_frequency; }},
    {"gimbal.servo.stepper.torque", [](const Servo& s) { return s.stepper && s.stepper->torque; }},
    {"gimbal.servo.time_constant", [](const Servo& s) { return s.time_constant.has_value(); }},
};

}  // namespace

Condition::Condition(std::string_view text) {
  const std::size_t above = text.find(">0");
  const std::size_t end = std::min(text.find('='), above);
  path = text.substr(0, end);
  positive = above != std::string_view::npos;
  const auto* const found = std::ranges::find(servo_keys, path, &ServoKey::path);
  if (found != std::ranges::end(servo_keys)) servo = found;
  if (positive) or_absent = text.ends_with('|');
  if (positive || end == std::string_view::npos) return;
  values = split(text.substr(end + 1), "|");
  or_absent = std::erase(values, "") > 0;
}

Conditions conditions(std::string_view text) {
  Conditions any;
  if (text.empty()) return any;
  for (const std::string_view alternative : split(text, " or ")) {
    auto& all = any.emplace_back();
    for (const std::string_view condition : split(alternative, " and ")) {
      all.emplace_back(condition);
    }
  }
  return any;
}

std::array<std::span<const KeyRelation>, 3> relations() {
  return {movers, moved, others};
}

}  // namespace bbsim::scenario
