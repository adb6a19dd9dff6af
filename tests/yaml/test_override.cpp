// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// --set key.path=value. tests/scenario/refused/text.yaml lists what is refused.
#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_override {

using namespace bbsim;
using namespace bbsim::test;

TEST_CASE("an override replaces a value") {
  CHECK(parse(open_loop, {"ball.radius=2 cm"}).ball.radius == 0.02);
  CHECK(parse(open_loop, {"ball.radius=\"2 cm\""}).ball.radius == 0.02);
  CHECK(parse(open_loop, {"ball.radius=1", "ball.radius=2"}).ball.radius == 2);
  CHECK(parse(open_loop, {"ball={radius: 3, mass: 4}"}).ball.mass == 4);
  CHECK(parse(open_loop, {"title=a=b"}).title == "a=b");
  CHECK(parse(closed_loop, {"controller.pd.kv=[[1,0],[0,-1]]"}).controller->kv ==
        Matrix2{{{1, 0}, {0, -1}}});
}

TEST_CASE("an override creates missing keys") {
  CHECK(parse(open_loop, {"solver.rtol=1e-3"}).solver.rtol == 1e-3);
  CHECK(parse(open_loop, {"ball.position=[1, 2]"}).ball.position == Pair{1, 2});
  const Scenario scenario =
      parse(open_loop, {"gimbal.motion.phi.ramp.rate=2", "gimbal.motion.phi.ramp.start=1"});
  CHECK(std::get<Ramp>(scenario.gimbal.motion->phi[0]).start == 1);
  CHECK(parse("ball:\n", {"ball.radius=1", "time.end=1", "time.step=1", "gimbal.motion={}"})
            .ball.radius == 1);
}

TEST_CASE("an override sets, appends and removes items of a list by their positions") {
  const auto columns = [](const std::vector<std::string>& overrides) {
    return parse(open_loop + "output: {columns: [t, x]}\n", overrides).output.columns;
  };
  using Columns = std::vector<std::string>;
  CHECK(columns({"output.columns.1=y"}) == Columns{"t", "y"});
  CHECK(columns({"output.columns.2=y"}) == Columns{"t", "x", "y"});
  CHECK(columns({"output.columns.0=null"}) == Columns{"x"});
  CHECK(columns({"output.columns.0=null", "output.columns.1=theta"}) == Columns{"x", "theta"});
  // One of a pair can be set if the scenario has no list.
  const Scenario scene = parse(open_loop, {"ball.velocity.1=0.2", "ball.position.0=1 cm"});
  CHECK(scene.ball.velocity == Pair{0, 0.2});
  CHECK(scene.ball.position == Pair{0.01, 0});
  CHECK(parse(open_loop, {"ball.velocity.1=2", "ball.velocity.0=1"}).ball.velocity == Pair{1, 2});
}

TEST_CASE("an override of null removes a key, which may be missing") {
  CHECK(parse(open_loop, {"ball.mass=3", "ball.mass=null"}).ball.mass == 1);  // the default
  CHECK(parse(open_loop + "title: a\n", {"title=~"}).title.empty());
  CHECK(parse(closed_loop, {"controller.limit=0.1", "controller.limit=null"}).controller->limit ==
        std::nullopt);
  const Scenario other = parse(
      closed_loop, {"controller.pd=null", "controller.pid={kp: [[1, 0], [0, -1]], kv: 0, ki: 0}",
                    "controller.drives=angle", "gimbal.servo={natural_frequency: 10, damping: 1}"});
  CHECK(other.controller->law == Law::pid);
  CHECK_FALSE(parse(closed_loop, {"controller=null", "gimbal.motion={}"}).controller.has_value());
  CHECK(parse(open_loop, {"ball.mass=null", "events.edge=null", "controller.pid.ki=null"})
            .ball.mass == 1);
  CHECK(parse(open_loop, {"title=null", "title=b"}).title == "b");
}

TEST_CASE("an override does not change other users of an alias") {
  const std::string text =
      "ball: {radius: 0.01}\ntime: {end: 1, step: 1}\n"
      "gimbal: {motion: {phi: &a {ramp: {start: 1, rate: 1}}, theta: *a}}\n";
  const Scenario scenario = parse(text, {"gimbal.motion.phi.ramp.start=5"});
  CHECK(std::get<Ramp>(scenario.gimbal.motion->phi[0]).start == 5);
  CHECK(std::get<Ramp>(scenario.gimbal.motion->theta[0]).start == 1);
}

}  // namespace bbsim_test::test_override
