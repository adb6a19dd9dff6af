// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenarios of tests/data, value by value. Decimal values and simple fractions of pi convert
// exactly and are compared exactly.
#include <numbers>

#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_scenarios {

using namespace bbsim;

namespace {

constexpr double quarter_turn = std::numbers::pi / 2;

Scenario read(const std::string& name) {
  return read_scenario(BBSIM_SOURCE_DIR "/tests/data/scenarios/" + name + ".yaml");
}

void check_common(const Scenario& scenario, double radius, Pair position, OutputTimes time) {
  CHECK(scenario.gravity == 9.81);
  CHECK(scenario.ball.radius == radius);
  CHECK(scenario.ball.mass == 1);
  CHECK(scenario.ball.position == position);
  CHECK(scenario.time.end == time.end);
  CHECK(scenario.time.step == time.step);
  CHECK(scenario.solver.method == Method::automatic);
  CHECK(scenario.solver.rtol == 1e-8);
  CHECK(scenario.solver.atol == 1e-10);
  CHECK(scenario.output.columns == Output().columns);
  CHECK(scenario.gimbal.motion.has_value() != scenario.controller.has_value());
}

void check_sinusoid(const Profile& profile, const Sinusoid& expected) {
  REQUIRE(profile.size() == 1);
  const auto& sinusoid = std::get<Sinusoid>(profile[0]);
  CHECK(sinusoid.amplitude == expected.amplitude);
  CHECK(sinusoid.frequency == expected.frequency);
  CHECK(sinusoid.phase == expected.phase);
  CHECK(sinusoid.offset == expected.offset);
}

void check_motion(const Scenario& scenario, const Sinusoid& phi, const Sinusoid& theta) {
  REQUIRE(scenario.gimbal.motion);
  check_sinusoid(scenario.gimbal.motion->phi, phi);
  check_sinusoid(scenario.gimbal.motion->theta, theta);
  CHECK_FALSE(scenario.gimbal.servo);
}

void check_controller(const Scenario& scenario, const Matrix2& kv, const Matrix2& kp,
                      Drives drives) {
  REQUIRE(scenario.controller);
  CHECK(scenario.controller->kv == kv);
  CHECK(scenario.controller->kp == kp);
  CHECK(scenario.controller->drives == drives);
  const auto& circle = std::get<CircleReference>(scenario.controller->reference);
  CHECK(circle.radius == 0.05);
  CHECK(circle.rate == -0.3);
  CHECK(circle.phase == 0);
  CHECK(scenario.gimbal.start.phi == 0);
  CHECK(scenario.gimbal.start.theta == 0);
  CHECK(scenario.gimbal.start.phi_rate == 0);
  CHECK(scenario.gimbal.start.theta_rate == 0);
  CHECK(scenario.gimbal.servo.has_value() == (drives == Drives::angle));
}

}  // namespace

TEST_CASE("fig2a") {
  const Scenario scenario = read("fig2a");
  CHECK(scenario.title == "Fig. 2(a), open loop");
  check_common(scenario, 0.01, {0, -0.1}, {10, 0.1});
  check_motion(scenario, {0.01, 1, quarter_turn, 0}, {-0.01, 1, 0, 0});
}

TEST_CASE("fast") {
  const Scenario scenario = read("fast");
  check_common(scenario, 0.01, {0, -0.1}, {10, 0.1});
  check_motion(scenario, {0.3, 5, quarter_turn, 0}, {-0.3, 5, 0, 0});
}

TEST_CASE("small-ball") {
  const Scenario scenario = read("small-ball");
  check_common(scenario, 1e-5, {0, -0.1}, {10, 0.1});
  check_motion(scenario, {0.01, 1, quarter_turn, 0}, {-0.01, 1, 0, 0});
}

TEST_CASE("spin") {
  const Scenario scenario = read("spin");
  check_common(scenario, 0.01, {0.1, -0.05}, {10, 0.1});
  CHECK(scenario.ball.velocity == Pair{0.2, 0});
  CHECK(scenario.ball.spin == 50);
  check_motion(scenario, {0.05, 3, quarter_turn, 0.01}, {-0.04, 2, 0, 0});
}

TEST_CASE("tumble") {
  const Scenario scenario = read("tumble");
  check_common(scenario, 0.01, {0.05, 0}, {5, 0.1});
  CHECK(scenario.ball.velocity == Pair{0, 0.1});
  CHECK(scenario.ball.spin == 5);
  REQUIRE(scenario.gimbal.motion);
  REQUIRE(scenario.gimbal.motion->phi.size() == 1);
  const auto& ramp = std::get<Ramp>(scenario.gimbal.motion->phi[0]);
  CHECK(ramp.start == 0);
  CHECK(ramp.rate == 2);
  REQUIRE(scenario.gimbal.motion->theta.size() == 1);
  CHECK(std::get<double>(scenario.gimbal.motion->theta[0]) == 0);
}

TEST_CASE("fig2b") {
  const Scenario scenario = read("fig2b");
  check_common(scenario, 0.01, {0.05, 0}, {21, 0.1});
  check_controller(scenario, {{{1, 0}, {0, -1}}}, {{{0.001, 0}, {0, -0.001}}}, Drives::angle);
  CHECK(scenario.gimbal.servo->natural_frequency == 10);
  CHECK(scenario.gimbal.servo->damping == 1);
}

TEST_CASE("fig2b-literal") {
  const Scenario scenario = read("fig2b-literal");
  check_common(scenario, 0.01, {0.05, 0}, {21, 0.01});
  check_controller(scenario, {{{100, 0}, {0, 100}}}, {{{0.1, 0}, {0, 0.1}}}, Drives::acceleration);
}

TEST_CASE("stiff-servo") {
  const Scenario scenario = read("stiff-servo");
  check_common(scenario, 0.01, {0.05, 0}, {21, 0.1});
  check_controller(scenario, {{{0.05, 0}, {0, -0.05}}}, {{{0.05, 0}, {0, -0.05}}}, Drives::angle);
  CHECK(scenario.gimbal.servo->natural_frequency == 2000);
  CHECK(scenario.gimbal.servo->damping == 1);
}

}  // namespace bbsim_test::test_scenarios
