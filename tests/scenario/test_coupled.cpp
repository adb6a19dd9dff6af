// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Valid and invalid scenes with losses, torques and sliding.
#include "catch.hpp"
#include "scenario/coupled.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_coupled {

using namespace bbsim;
using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

const std::string torque_driven =
    "ball: {radius: 0.02, mass: 0.05}\n"
    "plate: {inertia: [4e-3, 6e-3, 1e-2]}\n"
    "gimbal: {torque: {phi: 0.1}, motor: {rotor_inertia: 1e-3}}\n"
    "time: {end: 1, step: 0.1}\n";

const std::string commanded =
    "ball: {radius: 0.02, mass: 0.05}\n"
    "plate: {inertia: [4e-3, 6e-3, 1e-2]}\n"
    "gimbal: {motor: {position_loop: {kp: 4}}}\n"
    "controller: {pd: {kv: [[1, 0], [0, -1]], kp: [[1, 0], [0, -1]]}, drives: angle, reference: "
    "{point: [0, 0]}}\n"
    "time: {end: 1, step: 0.1}\n";

}  // namespace

TEST_CASE("losses, torques and sliding are read") {
  const Scenario losses = parse(
      open_loop, {"ball.mass=0.05", "ball.losses={rolling: 0.002, viscous: 2e-6, pivoting: 1e-4}"});
  CHECK(losses.ball.losses == Losses{0.002, 2e-6, 1e-4});
  const Scenario slides =
      parse(open_loop, {"events.slip={friction: 0.3, sliding_friction: 0.25, action: slide}",
                        "ball.rotation=[1, -2]"});
  CHECK(slides.events.slip->sliding == 0.25);
  CHECK(*slides.ball.rotation == Pair{1, -2});
  const Scenario torques =
      parse(torque_driven,
            {"plate.mass=0.5", "plate.centre_of_mass=-5 cm", "gimbal.ring_inertia=2e-3",
             "gimbal.torque.theta={sinusoid: {amplitude: 0.02, frequency: 0.5 Hz, phase: 90 deg}}",
             "gimbal.motor.torque_limit=0.2",
             "gimbal.motor.dc={resistance: 2, torque_constant: 0.05, gear: 4, voltage_limit: 12}"});
  CHECK(torques.plate.centre_of_mass == -0.05);
  CHECK(torques.gimbal.motor->dc->gear == 4);
  CHECK(std::get<Sinusoid>(torques.gimbal.torque->theta[0]).amplitude == 0.02);
  CHECK(scenario::moved_by_torques(torques));
  CHECK(scenario::moved_by_torques(parse(commanded)));
  CHECK_FALSE(scenario::is_coupled(parse(open_loop)));
}

TEST_CASE("invalid losses are refused with a reason") {
  CHECK_THAT(errors(open_loop, {"ball.losses.viscous=1e-6"}),
             Contains("ball.losses.viscous: found, but no ball.mass"));
  CHECK(errors(open_loop, {"ball.losses.rolling=1e-3"}).empty());
  CHECK_THAT(errors(open_loop, {"ball.losses.rolling=-1e-3"}), Contains("from 0 to 1"));
  CHECK_THAT(errors(open_loop, {"ball.losses.roling=1e-3"}), Contains("did you mean"));
  CHECK_THAT(errors(open_loop, {"ball.losses.pivoting=1e-3", "ball.inertia_factor=0"}),
             Contains("would stop at once"));
  CHECK_THAT(errors(open_loop, {"events.rest=stop"}), Contains("nothing brings the ball to rest"));
  CHECK_THAT(
      errors("ball: {radius: 0.01, losses: {rolling: 0.01}}\n"
             "time: {end: 10, step: 0.1}\n"
             "controller: {feedback_linearisation: {kv: 1, kp: 1}, reference: {point: [0, 0]}}\n"),
      Contains("ball.losses: found dry friction beside feedback_linearisation"));
  CHECK_THAT(errors(open_loop, {"output.columns=[t, energy_lost]"}),
             Contains("the ball rolls without losses"));
}

TEST_CASE("invalid sliding is refused with a reason") {
  CHECK_THAT(errors(open_loop, {"events.slip={friction: 0.3, action: slide}"}),
             Contains("sliding_friction: missing"));
  CHECK_THAT(errors(open_loop, {"events.slip={friction: 0.3, sliding_friction: 0.2}"}),
             Contains("allowed: only with action: slide"));
  CHECK_THAT(
      errors(open_loop, {"events.slip={friction: 0.3, sliding_friction: 0.4, action: slide}"}),
      Contains("found more than friction"));
  CHECK_THAT(errors(open_loop, {"ball.rotation=[0, 0]"}),
             Contains("allowed: only with events.slip"));
  CHECK_THAT(
      errors(open_loop, {"ball.inertia_factor=0",
                         "events.slip={friction: 0.3, sliding_friction: 0.2, action: slide}"}),
      Contains("nothing would make such a ball slide"));
  CHECK_THAT(
      errors(closed_loop, {"controller.drives=angle",
                           "gimbal.servo={natural_frequency: 10, damping: 1, angle_limit: 0.3}",
                           "events.slip={friction: 0.3, sliding_friction: 0.2, action: slide}"}),
      Contains("a servo that jolts the plate"));
}

TEST_CASE("invalid torques are refused with a reason") {
  CHECK(errors(torque_driven).empty());
  CHECK(errors(commanded).empty());
  CHECK_THAT(errors(torque_driven, {"ball={radius: 0.02}"}),
             Contains("ball: found no mass, but the ball's weight moves the gimbal"));
  CHECK_THAT(errors(torque_driven, {"plate={}"}), Contains("plate.inertia: missing"));
  CHECK_THAT(errors(torque_driven, {"gimbal.motion={}"}),
             Contains("gimbal.torque: found beside gimbal.motion"));
  CHECK_THAT(errors(torque_driven, {"gimbal.servo={natural_frequency: 9, damping: 1}"}),
             Contains("gimbal.servo: found beside gimbal.torque"));
  CHECK_THAT(errors(commanded, {"gimbal.servo={natural_frequency: 9, damping: 1}"}),
             Contains("gimbal.servo: found beside gimbal.motor"));
  CHECK_THAT(errors(commanded, {"gimbal.motor={viscous: 1e-3}"}),
             Contains("found without position_loop"));
  CHECK_THAT(errors(commanded, {"controller.drives=torque"}),
             Contains("position_loop: found, but controller.drives is torque"));
  CHECK_THAT(errors(commanded, {"controller.drives=voltage", "gimbal.motor={viscous: 1e-3}"}),
             Contains("gimbal.motor.dc: missing"));
  CHECK_THAT(errors(commanded, {"controller.drives=acceleration"}),
             Contains("gimbal.motor: found, but controller.drives is acceleration"));
  CHECK_THAT(errors(torque_driven, {"controller={pd: {kv: 1, kp: 1}}"}),
             Contains("gimbal.torque: found beside controller"));
  CHECK_THAT(errors(torque_driven, {"plate.centre_of_mass=0.1"}), Contains("without plate.mass"));
  CHECK_THAT(errors(torque_driven, {"events.stick=note"}), Contains("nothing holds an axis"));
  CHECK_THAT(errors(open_loop, {"gimbal.ring_inertia=1e-3"}),
             Contains("no torques move the gimbal"));
  CHECK_THAT(errors(open_loop, {"gimbal.motor={viscous: 1e-3}"}),
             Contains("gimbal.motor: found beside gimbal.motion"));
  CHECK_THAT(errors(open_loop, {"output.columns=[t, phi_torque]"}),
             Contains("no torques move the gimbal"));
  CHECK_THAT(errors(torque_driven, {"output.columns=[t, phi_current]"}),
             Contains("gimbal.motor.dc is not known"));
  CHECK_THAT(errors(torque_driven, {"gimbal.torque.phi=4 deg"}),
             Contains("allowed: a torque, such as 0.01 or"));
  CHECK_THAT(errors(commanded, {"controller={lqr: {position: 1, command: 1}, drives: angle, "
                                "reference: {point: [0, 0]}}",
                                "gimbal.motor.position_loop.ki=1"}),
             Contains("position_loop.ki: found beside lqr"));
}

TEST_CASE("impossible moments of inertia give a warning") {
  const auto remarks = [](const std::string& plate) {
    return parse(
               "ball: {radius: 0.02, mass: 0.1}\n"
               "gimbal: {torque: {phi: 0}}\n"
               "time: {end: 1, step: 0.1}\n"
               "plate: {" +
               plate + "}\n")
        .remarks;
  };
  CHECK(remarks("inertia: [2e-4, 3e-4, 5e-4]").empty());
  const auto normal = remarks("inertia: [2e-4, 3e-4, 5.1e-4]");
  REQUIRE(normal.size() == 1);
  CHECK(normal[0].find("plate.inertia: the moment about the normal is greater") !=
        std::string::npos);
  CHECK(remarks("inertia: [2e-4, 6e-4, 3e-4]").size() == 1);
  CHECK(remarks("inertia: [2e-4, 3e-4, 4e-4], mass: 0.2, centre_of_mass: 0.03").empty());
  const auto offset = remarks("inertia: [2e-4, 3e-4, 4e-4], mass: 0.2, centre_of_mass: 0.04");
  REQUIRE(offset.size() == 1);
  CHECK(offset[0].find("plate.centre_of_mass") != std::string::npos);
}

}  // namespace bbsim_test::test_coupled
