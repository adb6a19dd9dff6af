// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sketches of sketches/, each in a style that people publish, run unchanged and balance the
// ball.
#include <cstdlib>
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch/sketch.hpp"

namespace bbsim_test::test_styles {

namespace {

struct Style {
  std::string name;
  std::vector<std::string> more_files{};
  std::vector<std::string> settings{};
};

// Inverse kinematics need a plate with rods; commands are then the servos' angles.
const Style styles[] = {
    {"pid_touch"},
    {"busy_wait"},
    {"inverse_kinematics",
     {},
     {"--set", "gimbal.linkage={horn: \"2.4 cm\", arm: \"6 cm\", offset: [\"-1.6 cm\", \"7 cm\"]}",
      "--set", "gimbal.servo.angle_limit=\"60 deg\"", "--set", "controller.limit=\"50 deg\""}},
    {"camera"},
    {"kalman"},
    {"calibration"},
    {"forward", {"helpers.ino"}},
};

}  // namespace

TEST_CASE(
    "sketches in the style of published ones run unchanged, balance, and repeat byte for byte") {
  const Style& style = GENERATE(from_range(std::begin(styles), std::end(styles)));
  const Sketch sketch(style.name, style.more_files);
  CAPTURE(style.name, sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  std::vector<std::string> words = sketch.words("run", style.settings);
  words.insert(words.end(), {"-o", "-", "-q"});
  std::vector<std::string> strict = words;
  // Without noise, only the limit cycle from the screen's resolution remains.
  for (const char* axis : {"x", "y"}) {
    strict.insert(strict.end(), {"--expect", std::string("rms_") + axis + " from 7 s < 0.004"});
  }
  const Result first = bbsim(strict);
  CAPTURE(first.err);
  CHECK(first.exit_code == 0);
  for (int i = 0; i < 3; ++i) CHECK(bbsim(words).out == first.out);
}

TEST_CASE("a hundred runs of a sketch give the same bytes", "[slow]") {
  const std::string name = GENERATE("pid_touch", "camera");
  const Sketch sketch(name);
  const std::vector<std::string> words = sketch.words("run", {"-o", "-", "-q"});
  const std::string first = bbsim(words).out;
  CHECK(first.size() > 10000);
  for (int i = 0; i < 100; ++i) REQUIRE(bbsim(words).out == first);
}

TEST_CASE("a state machine moves the ball around its square and prints columns") {
  const Sketch sketch("square");
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result result = bbsim(sketch.words(
      "run",
      {"--set", "time.end=20", "--set", "output.columns=[t, x, y, target_x, target_y]", "--expect",
       "max_x from 4 s > 0.045", "--expect", "min_x from 4 s < -0.045", "--expect",
       "max_y from 4 s > 0.045", "--expect", "min_y from 4 s < -0.045", "--expect",
       "max_target_x >= 50", "--expect", "min_target_y <= -50", "-o", "-", "-q"}));
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
}

TEST_CASE("threads of a sweep have their own boards") {
  const Sketch sketch("pid_touch");
  const std::vector<std::string> cases{
      "--vary",    "ball.position.0=list:-0.06,-0.03,0,0.03,0.05,0.07",
      "--measure", "end_x,max_x,min_x",
      "-o",        "-",
      "-q"};
  std::vector<std::string> one = sketch.words("sweep", cases), four = one;
  one.insert(one.end(), {"-j", "1"});
  four.insert(four.end(), {"-j", "4"});
  const Result alone = bbsim(one);
  CAPTURE(alone.err);
  REQUIRE(alone.exit_code == 0);
  CHECK(bbsim(four).out == alone.out);
  const Result single =
      bbsim(sketch.words("run", {"--set", "ball.position.0=0.05", "--measure", "end_x", "-q", "-o",
                                 sketch.folder() / "run.csv"}));
  const std::string end_x = single.out.substr(single.out.rfind(',') + 1);
  CHECK(contains(alone.out, end_x.substr(0, end_x.find('\n'))));
}

TEST_CASE("the public PID_v1 compiles unchanged") {
  const char* const folder = std::getenv("BBSIM_PID_V1");  // not in the repository
  if (folder == nullptr) return;
  const Folder into;
  const Result made = bbsim(
      {"sketch", sketches("pid_touch/pid_touch.ino"), "-I", folder, "-o", into / "sketch.so"});
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  const Result run = bbsim({"run", std::string(BBSIM_SOURCE_DIR) + "/tests/sketch/rig.yaml",
                            "--set", "controller.library.file=" + (into / "sketch.so"), "--set",
                            "controller.library.wiring=" + sketches("pid_touch/wiring.yaml"),
                            "--expect", "rms_x from 7 s < 0.004", "-o", "-", "-q"});
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
}

}  // namespace bbsim_test::test_styles
