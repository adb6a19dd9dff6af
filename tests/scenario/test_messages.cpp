// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Exact texts of the most common errors.
#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_messages {

using Catch::Matchers::Contains;
using namespace bbsim::test;

TEST_CASE("a value out of range") {
  CHECK(errors("title: a ball\n"
               "time: {end: 1, step: 1}\n"
               "ball:\n"
               "  radius: -0.01\n"
               "gimbal: {motion: {}}\n") ==
        "scenario.yaml:4:11: ball.radius: found -0.01; allowed: a length greater than 0, such as "
        "0.01 or \"1 cm\"");
}

TEST_CASE("an unknown key names the nearest known one") {
  CHECK(errors(open_loop + "gravty: 9.81\n") ==
        "scenario.yaml:4:1: gravty: unknown key; did you mean gravity?");
  CHECK(errors("ball:\n"
               "  radius: 0.01\n"
               "  raduis: 0.01\n"
               "time: {end: 1, step: 1}\n"
               "gimbal: {motion: {}}\n") ==
        "scenario.yaml:3:3: ball.raduis: unknown key; did you mean ball.radius?");
}

TEST_CASE("a key of other tools gets bbsim's name for it") {
  CHECK_THAT(errors("servo: {damping: 1}\n"),
             Contains("servo: unknown key; did you mean gimbal.servo?"));
  CHECK_THAT(errors("controller: {pd: {kp: 1, kd: 1}}\n"),
             Contains("controller.pd.kd: unknown key; did you mean controller.pd.kv?"));
  CHECK_THAT(errors("controller: {pid: {kp: 1, kd: 1}}\n"),
             Contains("controller.pid.kd: unknown key; did you mean controller.pid.kv?"));
  CHECK_THAT(errors("time: {dt: 0.01}\n"),
             Contains("time.dt: unknown key; did you mean time.step?"));
}

TEST_CASE("an unknown key like no other lists the known ones") {
  CHECK(errors("ball: {radius: 0.01, colour: red}\n"
               "time: {end: 1, step: 1}\n"
               "gimbal: {motion: {}}\n") ==
        "scenario.yaml:1:22: ball.colour: unknown key; known keys here: radius, mass, position, "
        "velocity, spin, inertia_factor, rolling_radius, losses, rotation, push");
}

TEST_CASE("a missing key is reported at the mapping that lacks it") {
  CHECK(errors("time: {end: 1, step: 1}\n"
               "ball:\n"
               "  mass: 1\n"
               "gimbal: {motion: {}}\n") ==
        "scenario.yaml:2:1: ball.radius: missing; allowed: a length greater than 0, such as 0.01 "
        "or \"1 cm\"");
}

TEST_CASE("missing sections are reported by their required keys") {
  CHECK(errors("{}") ==
        "scenario.yaml:1:1: ball.radius: missing; allowed: a length greater than 0, such as 0.01 "
        "or \"1 cm\"\n"
        "scenario.yaml:1:1: time.end: missing; allowed: a time greater than 0, such as 0.02 or "
        "\"20 ms\"\n"
        "scenario.yaml:1:1: time.step: missing; allowed: a time greater than 0, such as 0.02 or "
        "\"20 ms\"\n"
        "scenario.yaml:1:1: gimbal.motion: missing, and so is controller; allowed: exactly one of "
        "the two");
}

TEST_CASE("a repeated key names the line of the first") {
  CHECK(errors("ball:\n"
               "  radius: 0.01\n"
               "  radius: 0.02\n"
               "time: {end: 1, step: 1}\n"
               "gimbal: {motion: {}}\n") ==
        "scenario.yaml:3:3: ball.radius: found again (first on line 2); allowed: each key once");
}

TEST_CASE("a wrong type") {
  CHECK(errors("ball: 3\ntime: {end: 1, step: 1}\ngimbal: {motion: {}}\n") ==
        "scenario.yaml:1:7: ball: found 3; allowed: a mapping with radius, mass, position, "
        "velocity, spin, inertia_factor, rolling_radius, losses, rotation, push");
  CHECK(errors("ball: {radius: [1, 2, 3], position: [1], velocity: {}, mass: , spin: fast}\n"
               "time: {end: 1, step: 1}\ngimbal: {motion: {}}\n") ==
        "scenario.yaml:1:16: ball.radius: found a list of 3; allowed: a length greater than 0, "
        "such as 0.01 or \"1 cm\"\n"
        "scenario.yaml:1:37: ball.position: found a list of 1; allowed: two lengths [x, y], such "
        "as [0.1, 0]\n"
        "scenario.yaml:1:52: ball.velocity: found a mapping; allowed: two velocities [x, y], such "
        "as [0.1, 0]\n"
        "scenario.yaml:1:62: ball.mass: found nothing; allowed: a mass greater than 0, such as 0.1 "
        "or \"100 g\"\n"
        "scenario.yaml:1:70: ball.spin: found fast; allowed: an angular rate, such as 3 or \"0.5 "
        "Hz\"");
}

TEST_CASE("a key without a value is reported at the key, whatever follows") {
  const std::string more = "time: {end: 1, step: 1}\n";
  CHECK(errors("ball:\n  radius: 0.01\n  mass:\n\n# a comment\ngimbal: {motion: {}}\n" + more) ==
        "scenario.yaml:3:3: ball.mass: found nothing; allowed: a mass greater than 0, such as 0.1 "
        "or \"100 g\"");
  CHECK_THAT(errors("ball: {radius: 0.01}\ngimbal: {motion: {}}\n" + more + "gravity:\n"),
             Catch::Matchers::StartsWith("scenario.yaml:4:1: gravity: found nothing"));
}

TEST_CASE("a quantity of another dimension, and a number in quotes") {
  CHECK(errors("ball: {radius: \"0.01\"}\ntime: {end: 10 cm, step: 1}\ngimbal: {motion: {}}\n") ==
        "scenario.yaml:1:16: ball.radius: found \"0.01\", a text (drop the quotes or add a unit); "
        "allowed: a length greater than 0, such as 0.01 or \"1 cm\"\n"
        "scenario.yaml:2:13: time.end: found 10 cm, a length; allowed: a time greater than 0, such "
        "as 0.02 or \"20 ms\"");
}

TEST_CASE("a missing value gives no errors from rules with other keys") {
  const std::string loop =
      "ball: {radius: 0.01}\ntime: {end: 1, step: 1}\n"
      "gimbal: {servo: {natural_frequency: 5, damping: 0.8}}\n"
      "controller:\n  gravity_compensation: {kp: 10, kv: 8}\n  drives: angle\n"
      "  reference: {point: [0, 0]}\n  sensor: {delay: 0.01}\n";
  CHECK(errors(loop + "  sampling: {period: 50 mm, delay: 0.01}\n") ==
        "scenario.yaml:9:22: controller.sampling.period: found 50 mm, a length; allowed: a "
        "time greater than 0, such as 0.02, \"20 ms\" or \"30 Hz\"");
  CHECK(errors(loop + "  sampling: {delay: 0.01}\n") ==
        "scenario.yaml:9:3: controller.sampling.period: missing; allowed: a time greater than 0, "
        "such as 0.02, \"20 ms\" or \"30 Hz\"");
}

TEST_CASE("an override is named in its errors") {
  CHECK(errors(open_loop, {"ball.mass=2", "ball.radius=abc"}) ==
        "--set ball.radius=abc: ball.radius: found abc; allowed: a length greater than 0, such as "
        "0.01 or \"1 cm\"");
  CHECK(errors(open_loop, {"ball.raduis=1"}) ==
        "--set ball.raduis=1: ball.raduis: unknown key; did you mean ball.radius?");
  CHECK(errors(open_loop, {"ball={mass: 1}"}) ==
        "--set ball={mass: 1}: ball.radius: missing; allowed: a length greater than 0, such as "
        "0.01 or \"1 cm\"");
}

TEST_CASE("errors come in the order of the file, then of the overrides") {
  CHECK(errors("time: {end: -1, step: 1}\n"
               "gimbal: {motion: {phi: x}}\n"
               "ball: {radius: 0}\n",
               {"solver.rtol=2", "gravity=-1"}) ==
        "scenario.yaml:1:13: time.end: found -1; allowed: a time greater than 0, such as 0.02 or "
        "\"20 ms\"\n"
        "scenario.yaml:2:24: gimbal.motion.phi: found x; allowed: an angle, such as 0.1 or \"4 "
        "deg\", or one of sinusoid, ramp, pulse, table\n"
        "scenario.yaml:3:16: ball.radius: found 0; allowed: a length greater than 0, such as 0.01 "
        "or \"1 cm\"\n"
        "--set solver.rtol=2: solver.rtol: found 2; allowed: a number from 1e-14 to 0.1, such as "
        "1e-8\n"
        "--set gravity=-1: gravity: found -1; allowed: an acceleration of at least 0, such as "
        "9.81 or \"9.81 m/s^2\"");
}

TEST_CASE("after fifty errors, the rest are counted") {
  std::string text = open_loop;
  for (int i = 0; i < 60; ++i) text += "unheard_of_" + std::to_string(i) + ": 1\n";
  try {
    static_cast<void>(parse(text));
    FAIL("accepted");
  } catch (const bbsim::InputError& e) {
    REQUIRE(e.problems().size() == 51);
    CHECK(e.problems()[49].where == "scenario.yaml:53:1");
    CHECK(e.problems()[50].where.empty());
    CHECK(e.problems()[50].message == "and 10 more problems");
  }
}

TEST_CASE("columns count characters, and control characters are shown as escapes") {
  CHECK(errors("{title: \"\u03b3\u03b3\\e[3m\\u009b\", " + open_loop.substr(0, 20) +
               ", time: {end: 1, step: 1}, gimbal: {motion: {}}}") ==
        "scenario.yaml:1:9: title: found \"\u03b3\u03b3\\x1b[3m\\u009b\", with control "
        "characters; allowed: a text");
  CHECK(errors("\xEF\xBB\xBF{title: \u03b3\u03b3\u03b3, gravity: x, " + open_loop.substr(0, 20) +
               ", time: {end: 1, step: 1}, gimbal: {motion: {}}}")
            .starts_with("scenario.yaml:1:23: gravity: found x;"));
}

TEST_CASE("a long value is cut off") {
  const std::string found = errors(open_loop + "gravity: " + std::string(1000, 'x') + "\n");
  CHECK(found.starts_with("scenario.yaml:4:10: gravity: found " + std::string(60, 'x') + "...;"));
}

}  // namespace bbsim_test::test_messages
