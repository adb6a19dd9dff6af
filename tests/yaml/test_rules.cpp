// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Values of keys. tests/scenario/refused/values.yaml lists those that are refused.
#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_rules {

using namespace bbsim;
using namespace bbsim::test;

TEST_CASE("the defaults") {
  const Scenario scenario = parse(open_loop);
  CHECK(scenario.title.empty());
  CHECK(scenario.gravity == 9.80665);
  CHECK(scenario.ball.radius == 0.01);
  CHECK(scenario.ball.mass == 1);
  CHECK(scenario.ball.position == Pair{0, 0});
  CHECK(scenario.ball.velocity == Pair{0, 0});
  CHECK(scenario.ball.spin == 0);
  REQUIRE(scenario.gimbal.motion);
  CHECK(scenario.gimbal.motion->phi.empty());
  CHECK(scenario.gimbal.motion->theta.empty());
  CHECK_FALSE(scenario.gimbal.servo);
  CHECK_FALSE(scenario.controller);
  CHECK(scenario.time.end == 10);
  CHECK(scenario.time.step == 0.1);
  CHECK(scenario.solver.method == Method::automatic);
  CHECK(scenario.solver.rtol == 1e-8);
  CHECK(scenario.solver.atol == 1e-10);
  CHECK(scenario.output.columns ==
        std::vector<std::string>{"t", "x", "y", "gamma", "phi", "theta"});
}

TEST_CASE("the source is kept") {
  const std::vector<std::string> overrides = {"gravity=1", "title=another"};
  const Scenario scenario = parse(open_loop, overrides);
  CHECK(scenario.source.file == "scenario.yaml");
  CHECK(scenario.source.text == open_loop);
  CHECK(scenario.source.overrides == overrides);
}

TEST_CASE("values at the limits of their ranges are read") {
  CHECK(parse(open_loop, {"gravity=0"}).gravity == 0);
  CHECK(parse(open_loop, {"solver.rtol=1e-14"}).solver.rtol == 1e-14);
  CHECK(parse(open_loop, {"solver.rtol=0.1"}).solver.rtol == 0.1);
  CHECK(parse(open_loop, {"solver.atol=1"}).solver.atol == 1);
  CHECK(parse(open_loop, {"time.end=1e9", "time.step=1"}).time.end == 1e9);
  CHECK(parse(open_loop, {"time.step=1000"}).time.step == 1000);
}

TEST_CASE("a gimbal's start, servo, gains and what they drive are read") {
  const Scenario loop = parse(closed_loop, {"gimbal.start={phi: \"4 deg\", theta_rate: 0.5}"});
  CHECK(loop.gimbal.start.phi == 0.06981317007977318);  // 4 pi / 180, rounded once
  CHECK(loop.gimbal.start.theta == 0);
  CHECK(loop.gimbal.start.phi_rate == 0);
  CHECK(loop.gimbal.start.theta_rate == 0.5);
  CHECK(loop.controller->drives == Drives::acceleration);
  CHECK(loop.controller->kv == Matrix2{{{100, 0}, {0, 100}}});
  CHECK(loop.controller->kp == Matrix2{{{0.1, 0}, {0, 0.1}}});
  CHECK(parse(closed_loop, {"controller.drives=acceleration"}).controller->drives ==
        Drives::acceleration);

  const Scenario servo = parse(
      closed_loop, {"controller.pd={kv: [[1, 2], [-3, -4]], kp: 0}", "controller.drives=angle",
                    "gimbal.servo={natural_frequency: 10, damping: 0}"});
  REQUIRE(servo.gimbal.servo);
  CHECK(servo.gimbal.servo->natural_frequency == 10);
  CHECK(servo.gimbal.servo->damping == 0);
  CHECK(servo.controller->drives == Drives::angle);
  CHECK(servo.controller->kv == Matrix2{{{1, 2}, {-3, -4}}});
}

TEST_CASE("words choose methods and columns") {
  for (const NamedMethod& method : named_methods) {
    CHECK(parse(open_loop, {"solver.method=" + std::string(method.name)}).solver.method ==
          method.method);
  }
  using Columns = std::vector<std::string>;
  CHECK(parse(open_loop, {"output.columns=[vy, x]"}).output.columns == Columns{"vy", "x"});
  CHECK(parse(closed_loop, {"output.columns=[t, x_reference]"}).output.columns ==
        Columns{"t", "x_reference"});
}

TEST_CASE("a title is any text") {
  CHECK(parse("title: 30 times\n" + open_loop).title == "30 times");
  CHECK(parse("title: |\n  two\n  lines\n" + open_loop).title == "two\nlines\n");
}

}  // namespace bbsim_test::test_rules
