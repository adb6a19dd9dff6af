// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// --set key.path=value
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

TEST_CASE("an override sets and appends list items by position") {
  const std::string text = open_loop + "output: {columns: [t, x]}\n";
  const std::vector<std::string> replaced = {"t", "y"};
  const std::vector<std::string> appended = {"t", "x", "y"};
  CHECK(parse(text, {"output.columns.1=y"}).output.columns == replaced);
  CHECK(parse(text, {"output.columns.2=y"}).output.columns == appended);
  CHECK(errors(text, {"output.columns.3=y"}) ==
        "--set output.columns.3=y: output.columns: found the position 3 in a list; allowed: 0 to "
        "2, where the last appends");
  CHECK(errors(text, {"output.columns.-1=y"}) ==
        "--set output.columns.-1=y: output.columns: found the position -1 in a list; allowed: 0 "
        "to 2, where the last appends");
  CHECK(errors(text, {"output.columns.01=y"}) ==
        "--set output.columns.01=y: output.columns: found the position 01 in a list; allowed: 0 to "
        "2, where the last appends");
  CHECK(errors(text, {"output.columns.99999999999999999999=y"}).find("found the position 9999") !=
        std::string::npos);
}

TEST_CASE("an override of null removes a key, or an item of a list") {
  CHECK(parse(open_loop, {"ball.mass=3", "ball.mass=null"}).ball.mass == 1);  // the default
  CHECK(parse(open_loop + "title: a\n", {"title=~"}).title.empty());
  CHECK(parse(closed_loop, {"controller.limit=0.1", "controller.limit=null"}).controller->limit ==
        std::nullopt);
  const Scenario other = parse(
      closed_loop, {"controller.pd=null", "controller.pid={kp: [[1, 0], [0, -1]], kv: 0, ki: 0}",
                    "controller.drives=angle", "gimbal.servo={natural_frequency: 10, damping: 1}"});
  CHECK(other.controller->law == Law::pid);
  CHECK_FALSE(parse(closed_loop, {"controller=null", "gimbal.motion={}"}).controller.has_value());
  CHECK(errors(open_loop, {"ball.radius=null"}) ==
        "scenario.yaml:1:1: ball.radius: missing; allowed: a length greater than 0, such as 0.01 "
        "or \"1 cm\"");

  const std::string listed = open_loop + "output: {columns: [t, x, y]}\n";
  const std::vector<std::string> without_x = {"t", "y"}, with_theta = {"t", "y", "theta"};
  CHECK(parse(listed, {"output.columns.1=null"}).output.columns == without_x);
  CHECK(parse(listed, {"output.columns.1=null", "output.columns.2=theta"}).output.columns ==
        with_theta);
  CHECK(errors(listed, {"output.columns.3=null"}) ==
        "--set output.columns.3=null: output.columns: found the position 3 in a list; allowed: 0 "
        "to 2");
}

TEST_CASE("missing keys may be removed, but their names must be known") {
  CHECK(parse(open_loop, {"ball.mass=null", "events.edge=null", "controller.pid.ki=null"})
            .ball.mass == 1);
  CHECK(parse(open_loop, {"title=null", "title=b"}).title == "b");
  CHECK(errors(open_loop, {"ball.mas=null"}) ==
        "--set ball.mas=null: ball.mas: unknown key; did you mean ball.mass?");
  CHECK(errors(open_loop, {"evnts.edge=null"}) ==
        "--set evnts.edge=null: evnts: unknown key; did you mean events?");
  CHECK(errors(open_loop, {"ball.radius.x=null"}) ==
        "--set ball.radius.x=null: ball.radius: found 0.01, which has no keys; allowed: a path "
        "through mappings and lists");
  // An unset script variable, or a file, removes nothing.
  CHECK(
      errors(open_loop, {"ball.mass="}).starts_with("--set ball.mass=: ball.mass: found nothing"));
  CHECK(errors(open_loop + "title: null\n").find("title: found nothing") != std::string::npos);
  CHECK_FALSE(errors(open_loop, {"ball={radius: 1, mass: null}"}).empty());
}

TEST_CASE("an override does not change other users of an alias") {
  const std::string text =
      "ball: {radius: 0.01}\ntime: {end: 1, step: 1}\n"
      "gimbal: {motion: {phi: &a {ramp: {start: 1, rate: 1}}, theta: *a}}\n";
  const Scenario scenario = parse(text, {"gimbal.motion.phi.ramp.start=5"});
  CHECK(std::get<Ramp>(scenario.gimbal.motion->phi[0]).start == 5);
  CHECK(std::get<Ramp>(scenario.gimbal.motion->theta[0]).start == 1);
}

TEST_CASE("a malformed override is refused") {
  CHECK(errors(open_loop, {"ball.radius"}) ==
        "--set ball.radius: found no =; allowed: key.path=value, such as ball.radius=0.02");
  const std::string empty_key =
      ": found an empty key before the =; allowed: key.path=value, such as ball.radius=0.02";
  for (const std::string text : {"=1", ".=1", "ball..radius=1", "ball.=1", ".ball=1"}) {
    CHECK(errors(open_loop, {text}) == std::string("--set ").append(text).append(empty_key));
  }
  CHECK(errors(open_loop, {"ball.radius.x=1"}) ==
        "--set ball.radius.x=1: ball.radius: found 0.01, which has no keys; allowed: a path "
        "through mappings and lists");
  CHECK(errors(open_loop, {"ball.radius=[1"}) ==
        "--set ball.radius=[1: found a list as a key, or one without its ]; allowed: a name");
  CHECK(errors(open_loop, {"ball.radius="}) ==
        "--set ball.radius=: ball.radius: found nothing; allowed: a length greater than 0, such "
        "as 0.01 or \"1 cm\"");
  CHECK(errors(open_loop, {"a=1\n---\n2"}) ==
        "--set a=1\\n---\\n2: found a second document; allowed: one in a file");
  CHECK(errors(open_loop, {"a=\x1b[3m"}) ==
        "--set a=\\x1b[3m: found the byte 0x1b; allowed: text in UTF-8");
}

TEST_CASE("an override cannot nest deeper than a file") {
  std::string path = "a";
  for (int i = 0; i < 40; ++i) path += ".a";
  CHECK(errors(open_loop, {path + "=1"})
            .ends_with("found nesting deeper than 32 levels; allowed: at most 32"));
}

TEST_CASE("a malformed override is reported together with the file's own errors") {
  CHECK(errors(open_loop + "gravity: -1\n", {"x"}) ==
        "scenario.yaml:4:10: gravity: found -1; allowed: an acceleration of at least 0, such as "
        "9.81 or \"9.81 m/s^2\"\n"
        "--set x: found no =; allowed: key.path=value, such as ball.radius=0.02");
}

TEST_CASE("one of a pair can be set if the scenario has no list") {
  const Scenario scene =
      test::parse(test::open_loop, {"ball.velocity.1=0.2", "ball.position.0=1 cm"});
  CHECK(scene.ball.velocity == Pair{0, 0.2});
  CHECK(scene.ball.position == Pair{0.01, 0});
  CHECK(test::parse(test::open_loop, {"ball.velocity.1=2", "ball.velocity.0=1"}).ball.velocity ==
        Pair{1, 2});
  CHECK(test::errors(test::open_loop, {"ball.velocity.1=x"}).find("ball.velocity.1: found x") !=
        std::string::npos);
  CHECK(
      test::errors(test::open_loop, {"ball.velocity.2=1"}).find("ball.velocity: found a mapping") !=
      std::string::npos);
  // In a file it must be a list.
  CHECK(test::errors("ball: {radius: 0.01, velocity: {0: 1}}\n"
                     "time: {end: 10, step: 0.1}\n"
                     "gimbal: {motion: {}}\n")
            .find("ball.velocity: found a mapping") != std::string::npos);
}

}  // namespace bbsim_test::test_override
