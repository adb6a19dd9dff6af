// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes with losses, torques and sliding.
#include "catch.hpp"
#include "scenario/coupled.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_coupled {

using namespace bbsim;
using namespace bbsim::test;

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
  CHECK(errors(open_loop, {"ball.losses.rolling=1e-3"}).empty());  // needs no mass
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
