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

}  // namespace

TEST_CASE("scenarios of prescribed motions") {
  struct Motion {
    std::string name;
    double radius;
    Pair position;
    Sinusoid phi, theta;
  };
  const auto [name, radius, position, phi, theta] = GENERATE(values<Motion>({
      {"fig2a", 0.01, {0, -0.1}, {0.01, 1, quarter_turn, 0}, {-0.01, 1, 0, 0}},
      {"fast", 0.01, {0, -0.1}, {0.3, 5, quarter_turn, 0}, {-0.3, 5, 0, 0}},
      {"small-ball", 1e-5, {0, -0.1}, {0.01, 1, quarter_turn, 0}, {-0.01, 1, 0, 0}},
      {"spin", 0.01, {0.1, -0.05}, {0.05, 3, quarter_turn, 0.01}, {-0.04, 2, 0, 0}},
  }));
  CAPTURE(name);
  const Scenario scenario = read(name);
  check_common(scenario, radius, position, {10, 0.1});
  REQUIRE(scenario.gimbal.motion);
  check_sinusoid(scenario.gimbal.motion->phi, phi);
  check_sinusoid(scenario.gimbal.motion->theta, theta);
  CHECK_FALSE(scenario.gimbal.servo);
  CHECK(scenario.ball.velocity == (name == "spin" ? Pair{0.2, 0} : Pair{0, 0}));
  CHECK(scenario.ball.spin == (name == "spin" ? 50 : 0));
  CHECK((scenario.title == "Fig. 2(a), open loop") == (name == "fig2a"));
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

TEST_CASE("scenarios of closed loops") {
  struct Loop {
    std::string name;
    double step, kv, kp;
    int theta;  // sign of theta's gains
    std::optional<double> natural_frequency;
  };
  const auto [name, step, kv, kp, theta, frequency] = GENERATE(values<Loop>({
      {"fig2b", 0.1, 1, 0.001, -1, 10},
      {"fig2b-literal", 0.01, 100, 0.1, 1, {}},
      {"stiff-servo", 0.1, 0.05, 0.05, -1, 2000},
  }));
  CAPTURE(name);
  const Scenario scenario = read(name);
  check_common(scenario, 0.01, {0.05, 0}, {21, step});
  REQUIRE(scenario.controller);
  CHECK(scenario.controller->kv == Matrix2{{{kv, 0}, {0, theta * kv}}});
  CHECK(scenario.controller->kp == Matrix2{{{kp, 0}, {0, theta * kp}}});
  CHECK(scenario.controller->drives == (frequency ? Drives::angle : Drives::acceleration));
  const auto& circle = std::get<CircleReference>(scenario.controller->reference);
  CHECK(circle.radius == 0.05);
  CHECK(circle.rate == -0.3);
  CHECK(circle.phase == 0);
  const GimbalStart& start = scenario.gimbal.start;
  for (const double zero : {start.phi, start.theta, start.phi_rate, start.theta_rate}) {
    CHECK(zero == 0);
  }
  REQUIRE(scenario.gimbal.servo.has_value() == frequency.has_value());
  if (!frequency) return;
  CHECK(scenario.gimbal.servo->natural_frequency == *frequency);
  CHECK(scenario.gimbal.servo->damping == 1);
}

}  // namespace bbsim_test::test_scenarios
