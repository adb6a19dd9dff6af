// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys of linkages, three servos, servos by axis, clocks, frames and pushes.
#include <yaml-cpp/yaml.h>

#include <vector>

#include "catch.hpp"
#include "scenario/calibration.hpp"
#include "support/folder.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_linkage {

using namespace bbsim;
using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

const std::string base =
    "ball: {radius: 0.02, mass: 0.05}\n"
    "gimbal: {servo: {natural_frequency: \"5 Hz\", damping: 0.8}}\n"
    "controller:\n"
    "  pd: {kv: [[1, 0], [0, -1]], kp: [[1, 0], [0, -1]]}\n"
    "  drives: angle\n"
    "  reference: {point: [0, 0]}\n"
    "time: {end: 1, step: 0.1}\n";

const std::string rods = "{horn: \"2.5 cm\", arm: \"8 cm\", offset: [\"6 cm\", 0.09]}";
const std::string three =
    "{radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11}";

}  // namespace

TEST_CASE("a linkage is read for both axes or for each one") {
  const Scenario both = parse(base, {"gimbal.linkage=" + rods, "controller.assumes=exact"});
  for (const auto& one : both.gimbal.linkage) {
    REQUIRE(one);
    const RodLinkage& of = std::get<RodLinkage>(*one);
    CHECK(of.horn == 0.025);
    CHECK(of.arm == 0.08);
    CHECK_FALSE(of.rod);
    CHECK(of.offset == Pair{0.06, 0.09});
  }
  CHECK(both.controller->assumes == Assumes::exact);

  Folder folder;
  const std::string table = folder.put("curve.csv", "a,b\n-1,-0.3\n-0.4,-0.1\n0.4,0.1\n1,0.3\n");
  const Scenario apart =
      parse(base, {"gimbal.linkage={phi: {horn: 0.02, arm: 0.05, rod: 0.1, offset: [0, 0.1]}, "
                   "theta: {table: {file: " +
                   table + ", servo: a, plate: b}}}"});
  CHECK(*std::get<RodLinkage>(*apart.gimbal.linkage[0]).rod == 0.1);
  CHECK(std::get<CurveLinkage>(*apart.gimbal.linkage[1]).plate ==
        std::vector<double>{-0.3, -0.1, 0.1, 0.3});
  REQUIRE(apart.tables.size() == 1);
  CHECK(apart.tables.front().second == table);
  const Scenario one = parse(base, {"gimbal.linkage={phi: " + rods + "}"});
  CHECK_FALSE(one.gimbal.linkage[1]);

  const Scenario of_three = parse(base, {"gimbal.three_servos=" + three});
  CHECK(of_three.gimbal.three_servos->radius_plate == 0.09);
}

TEST_CASE("a calibration is cleaned, and says how") {
  using Numbers = std::vector<double>;
  for (const YAML::Node& row :
       YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/scenario/calibrations.yaml")) {
    CurveLinkage curve{"", row["servo"].as<Numbers>(), row["plate"].as<Numbers>()};
    const auto done = row["done"].as<std::string>("");
    const scenario::Calibration made = scenario::calibrate(curve);
    CAPTURE(done);
    CHECK(made.done.empty() == done.empty());
    CHECK_THAT(made.done, Contains(done));
    CHECK(made.changes == row["changes"].as<bool>(false));
    CHECK(curve.smoothed == row["smoothed"].as<bool>(false));
    CHECK(curve.servo == (row["to servo"] ? row["to servo"] : row["servo"]).as<Numbers>());
    CHECK_THAT(curve.plate, Catch::Matchers::Approx(
                                (row["to plate"] ? row["to plate"] : row["plate"]).as<Numbers>())
                                .epsilon(1e-15));
  }
  // From a scenario, in degrees because of a column's name.
  const Folder folder;
  const std::string table = folder.put(
      "curve.csv", "servo_deg,plate [deg]\n40,10\n30,10\n20,8\n0,0\n0,0.5\n-20,-8\n-30,-10\n");
  const Scenario scene =
      parse(base, {"gimbal.linkage.table={file: " + table + ", servo: servo, plate: plate}"});
  const CurveLinkage& curve = std::get<CurveLinkage>(*scene.gimbal.linkage[0]);
  CHECK(curve.servo.size() == 5);
  CHECK(curve.servo.back() == Approx(0.5235987755982988));
}

TEST_CASE("an axis may have its own servo keys") {
  const Scenario scene =
      parse(base, {"gimbal.servo={natural_frequency: 30, damping: 0.8, rate_limit: 5, theta: "
                   "{natural_frequency: 20, angle_limit: 0.4}}"});
  CHECK(scene.gimbal.servo_of(0).natural_frequency == 30);
  CHECK(scene.gimbal.servo_of(0).angle_limit == unlimited);
  const Servo& theta = scene.gimbal.servo_of(1);
  CHECK(theta.natural_frequency == 20);
  CHECK(theta.damping == 0.8);
  CHECK(theta.rate_limit == 5);
  CHECK(theta.angle_limit == 0.4);
  // All keys by axis.
  const Scenario apart = parse(base, {"gimbal.servo={phi: {natural_frequency: 30, damping: 1}, "
                                      "theta: {natural_frequency: 20, damping: 0.7}}"});
  CHECK(apart.gimbal.servo_of(0).damping == 1);
  CHECK(apart.gimbal.servo_of(1).damping == 0.7);
  CHECK(errors(base, {"gimbal.servo.theta={angle_limit: 0.1}", "gimbal.start.phi=0.2"}).empty());
}

TEST_CASE("an axis may have its own limit of commands") {
  const Scenario scene = parse(base, {"controller.limit={phi: \"10 deg\", theta: 0.2}"});
  CHECK(*scene.controller->limit_of(0) == Approx(0.17453292519943295).epsilon(1e-15));
  CHECK(*scene.controller->limit_of(1) == 0.2);
  const Scenario one = parse(base, {"controller.limit={theta: 0.2}"});
  CHECK_FALSE(one.controller->limit_of(0));
}

TEST_CASE("clocks, frames and sensors are read in SI units") {
  Folder folder;
  const std::string periods = folder.put("periods.csv", "dt\n0.02\n0.021\n");
  const Scenario scene = parse(
      base, {"controller.sampling={period: 0.02, jitter: {file: " + periods + ", period: dt}}",
             "controller.sensor={rotation: \"2 deg\", offset: [\"1 mm\", 0], scale: 1.02, period: "
             "\"33 ms\", phase: 0.005}"});
  CHECK(scene.controller->sampling->periods == std::vector<double>{0.02, 0.021});
  const Sensor& sensor = *scene.controller->sensor;
  CHECK(sensor.rotation == Approx(0.03490658503988659).epsilon(1e-15));
  CHECK(sensor.offset == Pair{1e-3, 0});
  CHECK(sensor.scale == Pair{1.02, 1.02});
  CHECK(*sensor.period == 0.033);
  CHECK(sensor.phase == 0.005);
  const Scenario drawn = parse(base, {"controller.sampling={period: 0.02, jitter: \"1 ms\"}",
                                      "controller.sensor={seed: 3, scale: [1.1, 0.9]}"});
  CHECK(drawn.controller->sampling->jitter == 0.001);
  CHECK(drawn.controller->sensor->scale == Pair{1.1, 0.9});
  const Scenario pushed = parse(base, {"ball.push={x: 0.01, y: {sinusoid: {amplitude: 0.1, "
                                       "frequency: 1}}}"});
  CHECK(std::get<double>(pushed.ball.push->x[0]) == 0.01);
}

TEST_CASE("servos have the units of data sheets") {
  const Scenario sold = parse(
      base, {"gimbal.servo={model: hobby-standard, speed: \"0.17 s/60deg\", dead_band: \"4 us\", "
             "scale: \"0.1 deg\"}",
             "controller.sampling={period: \"50 Hz\"}", "controller.sensor={period: \"30 Hz\"}"});
  const Servo& servo = *sold.gimbal.servo;
  CHECK(servo.natural_frequency == Approx(37.69911184307752));
  CHECK(servo.damping == 0.9);
  CHECK(servo.rate_limit == Approx(6.159985595274104));
  CHECK(servo.angle_limit == Approx(1.0471975511965976));
  CHECK(servo.dead_band == Approx(0.006981317007977318));
  CHECK(servo.backlash == Approx(0.005235987755982988));
  CHECK(sold.controller->sampling->period == 0.02);
  CHECK(*sold.controller->sensor->period == 1.0 / 30);
}

TEST_CASE("each leg inherits keys from all legs") {
  const Scenario scene = parse(
      base,
      {"gimbal.three_servos={radius_base: \"6 cm\", radius_plate: 0.09, horn: 0.04, rod: 0.1, "
       "height: 0.11, legs: [{offset: \"2 deg\", direction: -1}, {angle: \"100 deg\", radius: "
       "0.07, servo: {angle_limit: \"40 deg\"}}, {rod: 0.102, joint_height: 0.004}]}"});
  const auto& legs = *scene.gimbal.three_servos->legs;
  CHECK(legs[0].angle == 0);
  CHECK(legs[0].offset == Approx(0.03490658503988659).epsilon(1e-15));
  CHECK(legs[0].direction == -1);
  CHECK(legs[0].radius_base == 0.06);
  CHECK(legs[1].angle == Approx(1.7453292519943295).epsilon(1e-15));
  CHECK(legs[1].radius_base == 0.07);
  CHECK(legs[1].radius_plate == 0.07);
  CHECK(legs[1].rod == 0.1);
  CHECK(legs[1].servo->angle_limit == Approx(0.6981317007977318));
  CHECK(legs[1].servo->natural_frequency == scene.gimbal.servo->natural_frequency);
  CHECK(!legs[0].servo);
  CHECK(legs[2].angle == Approx(4.1887902047863905).epsilon(1e-15));
  CHECK(legs[2].rod == 0.102);
  CHECK(legs[2].joint_height == 0.004);
}

TEST_CASE("a groove makes a smaller ball with more inertia, on one axis") {
  const std::string beam =
      "ball: {radius: 0.02, mass: 0.05, rolling_radius: \"1.2 cm\", position: [0.1, 0]}\n"
      "gimbal: {servo: {natural_frequency: \"5 Hz\", damping: 0.8}}\n"
      "controller:\n"
      "  pd: {kv: [[1, 0], [0, -1]], kp: [[1, 0], [0, -1]]}\n"
      "  drives: angle\n"
      "  reference: {point: [0.05, 0]}\n"
      "  sampling: {period: 0.02}\n"
      "  sensor: {noise: 0.001, rotation: 0.1}\n"
      "time: {end: 1, step: 0.1}\n";
  const Scenario scene = parse(beam, {});
  CHECK(scene.ball.radius == 0.012);
  CHECK(scene.ball.inertia_factor == Approx(0.4 / 0.36).epsilon(1e-15));
  CHECK(scene.ball.groove->ball_radius == 0.02);
  CHECK(scene.ball.groove->axis == 0);
  CHECK(scene.controller->sensor->only == 0);
  const Scenario along_y =
      parse(beam, {"ball.position=[0, 0.1]", "controller.reference.point=[0, 0.05]"});
  CHECK(along_y.ball.groove->axis == 1);
}

}  // namespace bbsim_test::test_linkage
