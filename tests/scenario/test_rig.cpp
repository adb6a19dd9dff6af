// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys of real rigs.
#include <numbers>

#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_rig {

using namespace bbsim;
using namespace bbsim::test;

namespace {

const std::string base =
    "ball: {radius: 0.02}\n"
    "gimbal: {servo: {natural_frequency: \"5 Hz\", damping: 0.8}}\n"
    "controller:\n"
    "  pd: {kv: [[1, 0], [0, -1]], kp: [[1, 0], [0, -1]]}\n"
    "  drives: angle\n"
    "  reference: {point: [0, 0]}\n"
    "time: {end: 1, step: 0.1}\n";

}  // namespace

TEST_CASE("commands may be known beforehand") {
  const Scenario scene = parse(
      base, {"controller.pd=null", "controller.reference=null", "controller.commands.phi=0.01"});
  REQUIRE(commands_of(scene) != nullptr);
  CHECK(std::get<double>(commands_of(scene)->phi.front()) == 0.01);
  const Scenario pursued = parse(base);
  CHECK(commands_of(pursued) == nullptr);
}

TEST_CASE("the parts of a rig are read in SI units") {
  const Scenario scene =
      parse(base, {"gimbal.servo.rate_limit=\"300 deg/s\"", "gimbal.servo.angle_limit=\"25 deg\"",
                   "gimbal.servo.dead_band=0.001", "gimbal.servo.backlash=0.002",
                   "gimbal.servo.acceleration_limit=200", "gimbal.mounting.height=\"5 cm\"",
                   "controller.limit=\"12 deg\"", "controller.sampling.period=\"20 ms\"",
                   "controller.sampling.delay=\"5 ms\"", "controller.sensor.noise=\"0.2 mm\"",
                   "controller.sensor.seed=7", "controller.sensor.area=[\"20 cm\", 0.15]",
                   "plate.size=[0.3, 0.2]", "plate.inertia=[1e-3, 2e-3, 3e-3]", "events.edge=stop",
                   "events.slip={friction: 0.3}", "ball.inertia_factor=0.5"});
  const Servo& servo = *scene.gimbal.servo;
  CHECK(servo.rate_limit == Approx(5.235987755982989).epsilon(1e-15));
  CHECK(servo.angle_limit == Approx(0.4363323129985824).epsilon(1e-15));
  CHECK(servo.dead_band == 0.001);
  CHECK(servo.backlash == 0.002);
  CHECK(servo.acceleration_limit == 200);
  CHECK(scene.gimbal.mounting.height == 0.05);
  CHECK(*scene.controller->limit == Approx(0.20943951023931956).epsilon(1e-15));
  CHECK(scene.controller->sampling->period == 0.02);
  CHECK(scene.controller->sampling->delay == 0.005);
  CHECK(scene.controller->sensor->noise == 2e-4);
  CHECK(scene.controller->sensor->seed == 7);
  CHECK(*scene.controller->sensor->area == Pair{0.2, 0.15});
  CHECK(*scene.plate.size == Pair{0.3, 0.2});
  CHECK(scene.plate.inertia->at(2) == 3e-3);
  CHECK(*scene.events.edge == OnEvent::stop);
  CHECK(scene.events.slip->friction == 0.3);
  CHECK(scene.events.slip->action == OnEvent::note);
  CHECK(scene.ball.inertia_factor == 0.5);
}

TEST_CASE("each law reads its own gains") {
  const auto law = [](const std::string& text) {
    return *parse(base, {"controller={" + text + ", drives: angle, reference: {point: [0, 0]}}"})
                .controller;
  };
  CHECK(law("pid: {kp: 0, kv: 0, ki: [[3, 0], [0, -3]]}").ki == Matrix2{{{3, 0}, {0, -3}}});
  const Controller feedback = law("state_feedback: {gain: [[1, 2, 3, 4], [5, 6, 7, 8]]}");
  CHECK(feedback.law == Law::state_feedback);
  CHECK(feedback.gain[1][3] == 8);
  CHECK(feedback.gain[1][4] == 0);
  CHECK(law("lqr: {position: 10, command: 0.5}").weights.command == 0.5);
  CHECK(law("gravity_compensation: {kp: 4, kv: 4}").law == Law::gravity_compensation);
}

TEST_CASE("a seed is allowed with random parts, even if they are switched off") {
  for (const char* drawn :
       {"noise=0.001", "noise=0", "dropout=0.1", "stuck={probability: 0.1, duration: 1}"}) {
    CHECK(errors(base, {"controller.sampling.period=0.01", "controller.sensor.seed=3",
                        std::string("controller.sensor.") + drawn})
              .empty());
  }
}

TEST_CASE("a contact force greater than the ball's weight gives a warning") {
  const auto warnings = [](const std::string& force) {
    return parse(base, {"ball.mass=0.1", "controller.sampling.period=0.02",
                        "controller.sensor.contact_force=" + force})
        .remarks;
  };
  CHECK(warnings("0.9").empty());
  CHECK(warnings("20 mN").empty());
  REQUIRE(warnings("1").size() == 1);
  CHECK_THAT(warnings("1")[0], Catch::Matchers::Contains("exceeds the ball's weight of 0.98"));
}

TEST_CASE("a stepper has a class, or a torque and an inertia, and may swing") {
  const auto stepper = [](const std::string& keys) {
    return parse(base,
                 {"gimbal.servo={rate_limit: 5, acceleration_limit: 60, stepper: " + keys + "}",
                  "controller.sampling.period=0.02"})
        .gimbal.servo->stepper;
  };
  const auto motor = stepper("{model: nema17, inertia: 2e-4}");
  CHECK(motor->steps == 200);
  CHECK(motor->torque == 0.175);  // half of its data sheet's 0.35 N m
  CHECK(motor->inertia == 2e-4);
  CHECK(*stepper("{model: nema23}")->torque > *stepper("{model: nema14}")->torque);
  CHECK(stepper("{torque: 0.2, inertia: 1e-4}")->torque == 0.2);
  CHECK(errors(base, {"gimbal.servo={rate_limit: 5, acceleration_limit: 60, stepper: {model: "
                      "nema17}}",
                      "controller.sampling.period=0.02", "events.steps_lost=stop"})
            .empty());
  CHECK_FALSE(stepper("{}")->natural_frequency);
  const auto rings = stepper("{natural_frequency: 40 Hz}");
  CHECK(*rings->natural_frequency == Approx(80 * std::numbers::pi).epsilon(1e-15));
  CHECK(rings->damping == 0.1);
}

}  // namespace bbsim_test::test_rig
