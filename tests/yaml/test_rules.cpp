// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Valid and refused values of each key.
#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_rules {

using namespace bbsim;
using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

// Checks that setting `assignment` is refused with `message` (without its "--set ...: ").
void check_refused(const std::string& base, const std::string& assignment,
                   const std::string& message) {
  INFO(assignment);
  CHECK(errors(base, {assignment}) == "--set " + assignment + ": " + message);
}

}  // namespace

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

TEST_CASE("values at the limits of their ranges") {
  CHECK(parse(open_loop, {"gravity=0"}).gravity == 0);
  CHECK(parse(open_loop, {"solver.rtol=1e-14"}).solver.rtol == 1e-14);
  CHECK(parse(open_loop, {"solver.rtol=0.1"}).solver.rtol == 0.1);
  CHECK(parse(open_loop, {"solver.atol=1"}).solver.atol == 1);
  CHECK(parse(open_loop, {"time.end=1e9", "time.step=1"}).time.end == 1e9);
  CHECK(parse(open_loop, {"time.step=1000"}).time.step == 1000);

  CHECK_THAT(errors(open_loop, {"gravity=-1e-300"}), Contains("gravity: found -1e-300"));
  CHECK_THAT(errors(open_loop, {"ball.mass=0"}), Contains("ball.mass: found 0; allowed: a mass"));
  CHECK_THAT(errors(open_loop, {"solver.rtol=0.99e-14"}), Contains("from 1e-14 to 0.1"));
  CHECK_THAT(errors(open_loop, {"solver.rtol=0.2"}), Contains("from 1e-14 to 0.1"));
  CHECK_THAT(errors(open_loop, {"solver.atol=0"}), Contains("greater than 0 and at most 1"));
  CHECK_THAT(errors(open_loop, {"solver.atol=1.1"}), Contains("greater than 0 and at most 1"));
  CHECK_THAT(errors(open_loop, {"time.step=-0.1"}), Contains("time.step: found -0.1"));
  CHECK_THAT(errors(open_loop, {"ball.spin=.inf"}), Contains("found .inf, which is not finite"));
  CHECK_THAT(errors(open_loop, {"ball.position=[.nan, 0]"}),
             Contains("ball.position.0: found .nan, which is not finite"));
  check_refused(open_loop, "time.step=1 ns",
                "time.step: found 1 ns, more than 1e9 rows of output; allowed: a time of at least "
                "1e-08");
}

TEST_CASE("exactly one of a prescribed motion and a controller") {
  CHECK(errors(closed_loop + "gimbal:\n  motion: {}\n") ==
        "scenario.yaml:3:1: controller: found beside gimbal.motion; allowed: exactly one of the "
        "two, since either the scenario prescribes the motion or the controller drives it");
  CHECK(errors("ball: {radius: 0.01}\ntime: {end: 10, step: 0.1}\n\ngimbal: {}\n") ==
        "scenario.yaml:4:1: gimbal.motion: missing, and so is controller; allowed: exactly one of "
        "the two");
}

TEST_CASE("the start of the gimbal belongs to a controller") {
  const Scenario scenario =
      parse(closed_loop + "gimbal: {start: {phi: \"4 deg\", theta_rate: 0.5}}\n");
  CHECK(scenario.gimbal.start.phi == 0.06981317007977318);  // 4 pi / 180, rounded once
  CHECK(scenario.gimbal.start.theta == 0);
  CHECK(scenario.gimbal.start.phi_rate == 0);
  CHECK(scenario.gimbal.start.theta_rate == 0.5);
  check_refused(open_loop, "gimbal.start={}",
                "gimbal.start: found beside gimbal.motion, which determines where the gimbal "
                "starts; allowed: only with a controller");
}

TEST_CASE("the servo belongs to a controller that drives angle") {
  const std::string servo = "gimbal: {servo: {natural_frequency: 10, damping: 0}}\n";
  const std::string pd = "controller.pd={kv: [[1, 0], [0, -1]], kp: 0}";
  const Scenario scenario = parse(closed_loop + servo, {pd, "controller.drives=angle"});
  REQUIRE(scenario.gimbal.servo);
  CHECK(scenario.gimbal.servo->natural_frequency == 10);
  CHECK(scenario.gimbal.servo->damping == 0);
  CHECK(scenario.controller->drives == Drives::angle);

  CHECK(errors(closed_loop + servo) ==
        "scenario.yaml:4:10: gimbal.servo: found, but controller.drives is acceleration, which no "
        "servo follows; allowed: only with drives: angle");
  CHECK(errors(closed_loop, {pd, "controller.drives=angle"}) ==
        "scenario.yaml:1:1: gimbal.servo: missing, but controller.drives is angle; allowed: a "
        "mapping with natural_frequency, damping");
  check_refused(
      open_loop, "gimbal.servo={natural_frequency: 10, damping: 1}",
      "gimbal.servo: found beside gimbal.motion, which no servo follows; allowed: only "
      "with a controller that drives angle, such as controller.commands, which plays known "
      "commands");
  CHECK_THAT(errors(closed_loop + servo, {"gimbal.servo.natural_frequency=0"}),
             Contains("an angular rate greater than 0"));
  CHECK_THAT(errors(closed_loop + servo, {"gimbal.servo.damping=-1"}),
             Contains("a number of at least 0, such as 1"));
}

TEST_CASE("what the controller drives") {
  CHECK(parse(closed_loop).controller->drives == Drives::acceleration);
  CHECK(parse(closed_loop, {"controller.drives=acceleration"}).controller->drives ==
        Drives::acceleration);
  check_refused(closed_loop, "controller.drives=angel",
                "controller.drives: found angel (did you mean angle?); allowed: one of "
                "acceleration, angle, torque, voltage, legs");
  check_refused(closed_loop, "controller.drives=",
                "controller.drives: found nothing; allowed: one of acceleration, angle, torque, "
                "voltage, legs");
}

TEST_CASE("gains are a number or a matrix") {
  const Scenario scalar = parse(closed_loop);
  CHECK(scalar.controller->kv == Matrix2{{{100, 0}, {0, 100}}});
  CHECK(scalar.controller->kp == Matrix2{{{0.1, 0}, {0, 0.1}}});
  const Scenario matrix = parse(closed_loop, {"controller.pd.kv=[[1, 2], [-3, -4]]"});
  CHECK(matrix.controller->kv == Matrix2{{{1, 2}, {-3, -4}}});

  const std::string allowed = "a number k, for [[k, 0], [0, k]], or a 2x2 matrix [[a, b], [c, d]]";
  check_refused(closed_loop, "controller.pd.kv=[1, 2, 3]",
                "controller.pd.kv: found a list of 3; allowed: " + allowed);
  check_refused(closed_loop, "controller.pd.kv=\"1\"",
                "controller.pd.kv: found \"1\", a text (drop the quotes); allowed: " + allowed);
  check_refused(closed_loop, "controller.pd.kv=1 m",
                "controller.pd.kv: found 1 m, a length; allowed: " + allowed);
  check_refused(closed_loop, "controller.pd.kv=[[1, 0], 2]",
                "controller.pd.kv.1: found 2; allowed: a row of two numbers, such as [1, 0]");
  CHECK_THAT(errors(closed_loop, {"controller.pd.kv=[[1, x], [0, 1]]"}),
             Contains("controller.pd.kv.0.1: found x; allowed: a number, such as 1"));
  CHECK_THAT(errors(closed_loop, {"controller.pd={kv: 1}"}),
             Contains("controller.pd.kp: missing; allowed: " + allowed));
}

TEST_CASE("the solver's method is one of the named ones") {
  for (const NamedMethod& method : named_methods) {
    CHECK(parse(open_loop, {"solver.method=" + std::string(method.name)}).solver.method ==
          method.method);
  }
  CHECK_THAT(errors(open_loop, {"solver.method=bfd"}), Contains("found bfd (did you mean bdf?)"));
  CHECK_THAT(errors(open_loop, {"solver.method=[bdf]"}), Contains("found a list of 1"));
}

TEST_CASE("output columns are known ones, each once") {
  const std::vector<std::string> chosen = {"vy", "x"};
  CHECK(parse(open_loop, {"output.columns=[vy, x]"}).output.columns == chosen);
  CHECK_THAT(errors(open_loop, {"output.columns=[]"}), Contains("found an empty list"));
  CHECK_THAT(errors(open_loop, {"output.columns=x"}),
             Contains("output.columns: found x; allowed: a list of columns, such as [t, x, y]"));
  CHECK_THAT(errors(open_loop, {"output.columns=[t, gama]"}),
             Contains("output.columns.1: found gama (did you mean gamma?); allowed: one of t, x,"));
  CHECK_THAT(errors(open_loop, {"output.columns=[t, [x]]"}),
             Contains("output.columns.1: found a list of 1; allowed: one of t, x,"));
  check_refused(open_loop, "output.columns=[t, x, t]",
                "output.columns.2: found t again; allowed: each column once");
}

TEST_CASE("reference columns need a controller") {
  const std::vector<std::string> chosen = {"t", "x_reference"};
  CHECK(parse(closed_loop, {"output.columns=[t, x_reference]"}).output.columns == chosen);
  check_refused(open_loop, "output.columns=[t, x_reference]",
                "output.columns.1: found x_reference, but there is no controller; allowed: columns "
                "of an open loop, such as x");
}

TEST_CASE("a title is a text") {
  CHECK(parse("title: 30 times\n" + open_loop).title == "30 times");
  CHECK(parse("title: |\n  two\n  lines\n" + open_loop).title == "two\nlines\n");
  CHECK_THAT(errors("title: [a]\n" + open_loop), Contains("title: found a list of 1"));
  CHECK_THAT(errors("title: \"a\\0\"\n" + open_loop), Contains("with control characters"));
}

}  // namespace bbsim_test::test_rules
