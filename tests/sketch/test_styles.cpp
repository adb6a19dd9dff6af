// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sketches of sketches/, each in a style that people publish, run unchanged and balance the
// ball.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch/sketch.hpp"

namespace bbsim_test::test_styles {

namespace {

// The rows of a CSV file of numbers, without comments and header.
std::vector<std::vector<double>> numbers_of(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    std::vector<double>& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  }
  return rows;
}

struct Style {
  std::string name;
  std::vector<std::string> more_files{};
  std::vector<std::string> settings{};
};

const std::vector<std::string> stepper_rig{"--set",
                                           "gimbal.servo={stepper: {steps: 200, microsteps: 16}}",
                                           "--set", "controller.sampling.period=\"1 ms\""};
const std::vector<std::string> stepper_legs{
    "--set",
    "gimbal.servo={stepper: {steps: 200, microsteps: 16}}",
    "--set",
    "gimbal.three_servos={radius_base: \"10 cm\", radius_plate: \"10 cm\", horn: \"5 cm\", rod: "
    "\"12 cm\", height: \"12 cm\"}",
    "--set",
    "controller.drives=legs",
    "--set",
    "controller.sampling.period=\"1 ms\""};

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
    {"steppers", {}, stepper_rig},
    {"stepper_legs", {}, stepper_legs},
    {"pca_legs", {}, {stepper_legs.begin() + 2, stepper_legs.end() - 2}},
    {"beam", {}, {"--set", "ball.position=[\"-5 cm\", 0]"}},
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

TEST_CASE("pulses turn a stepper by microsteps, at a constant rate from sample to sample") {
  // 100 steps forward at 1 kHz after 10 ms, then 20 back, one of them while the driver is off.
  const Sketch sketch(
      "int n = 0;\nvoid setup() { pinMode(2, OUTPUT); pinMode(3, OUTPUT); pinMode(8, OUTPUT); }\n"
      "void loop() {\n  if (millis() < 10) return;\n  while (n < 120) {\n"
      "    digitalWrite(3, n < 100 ? HIGH : LOW); digitalWrite(8, n == 119 ? HIGH : LOW);\n"
      "    digitalWrite(2, HIGH); digitalWrite(2, LOW); n++; delayMicroseconds(984);\n  }\n}\n",
      "steppers: {phi: {step: 2, dir: 3, enable: 8}}\n");
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result run = bbsim(sketch.words(
      "run", {"--set", "gimbal.servo={stepper: {steps: 200, microsteps: 8, gear: 2}}", "--set",
              "controller.sampling.period=\"2 ms\"", "--set", "time={end: 0.2, step: 1 ms}",
              "--set", "events={}", "--set", "output.columns=[t, phi, phi_rate, phi_believed]",
              "--expect", "max_phi < 0.1964", "--expect", "max_phi > 0.1963", "-o",
              sketch.folder() / "run.csv", "-q"}));
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  constexpr double step = 2 * 3.14159265358979324 / (200 * 8 * 2);
  const std::vector<std::vector<double>> rows = numbers_of(sketch.folder() / "run.csv");
  REQUIRE(rows.size() == 201);
  for (const std::vector<double>& row : rows) CHECK(row[1] == row[3]);
  // At the samples the shaft is where the pulses have brought it. The board's clock shows 2 ms at
  // t = 0.
  CHECK(std::abs(rows[60][1] - 52 * step) < 1.01 * step);
  CHECK(std::abs(rows[60][2] - 1000 * step) < 1e-6);
  CHECK(std::abs(rows[200][1] - 81 * step) < 1e-12);
}

TEST_CASE("check finds the gains of a sketch that pulses steppers after its ramp") {
  const Sketch sketch("steppers");
  CAPTURE(sketch.made.err);
  REQUIRE(sketch.made.exit_code == 0);
  const Result check = bbsim(sketch.words("check", stepper_rig));
  CAPTURE(check.out, check.err);
  REQUIRE(check.exit_code == 0);
  for (const std::string command : {"phi", "theta"}) {
    const std::string before = command + ": pushes the ball towards the reference; gain ";
    const std::size_t at = check.out.find(before);
    REQUIRE(at != std::string::npos);
    // 0.6 degrees for each cm, in whole microsteps of 0.11 degrees.
    const double gain = std::abs(std::strtod(check.out.c_str() + at + before.size(), nullptr));
    CHECK(std::abs(gain - 1.047) < 0.1);
  }
}

TEST_CASE("a wiring and a scenario agree on what is a stepper") {
  const std::string text = "void setup() {}\nvoid loop() {}\n";
  const Sketch steppers(text, "steppers: {phi: {step: 2, dir: 3}}\n");
  const Result servo = bbsim(steppers.words("run", {"-o", "-", "-q"}));
  CHECK(servo.exit_code == 2);
  CHECK(contains(servo.err, "wires a stepper where the scenario has a servo"));
  const Sketch servos(text, "servos: {phi: {pin: 2}}\n");
  std::vector<std::string> words = servos.words("run", stepper_rig);
  words.insert(words.end(), {"-o", "-", "-q"});
  const Result stepper = bbsim(words);
  CHECK(stepper.exit_code == 2);
  CHECK(contains(stepper.err, "wires a servo where the scenario has a stepper"));
  words.insert(words.end(), {"--set", "gimbal.servo.rate_limit=1"});
  const Result limited = bbsim(words);
  CHECK(limited.exit_code == 2);
  CHECK(contains(limited.err, "the sketch's pulses make the ramp"));
}

TEST_CASE("homing that ends elsewhere than the run begins, or never, is refused with its angles") {
  const Sketch elsewhere("void setup() {}\nvoid loop() {}\n",
                         "steppers: {phi: {step: 2, dir: 3, start: \"10 deg\"}}\n");
  std::vector<std::string> words = elsewhere.words("run", stepper_rig);
  words.insert(words.end(), {"-o", "-", "-q"});
  const Result off = bbsim(words);
  CHECK(off.exit_code == 2);
  CHECK(contains(off.err, "wiring.yaml"));
  CHECK(contains(off.err, "the motor phi stands at 10 deg"));
  const Sketch never(
      "void setup() {\n  pinMode(2, OUTPUT); pinMode(3, OUTPUT); pinMode(9, INPUT_PULLUP);\n"
      "  while (digitalRead(9) == HIGH) { digitalWrite(2, HIGH); digitalWrite(2, LOW); delay(20); "
      "}\n"
      "}\nvoid loop() {}\n",
      "steppers: {phi: {step: 2, dir: 3, start: 0, home: {pin: 9, angle: \"10 deg\"}}}\n");
  words = never.words("run", stepper_rig);
  words.insert(words.end(), {"-o", "-", "-q"});
  const Result endless = bbsim(words);
  CHECK(endless.exit_code != 0);
  CHECK(contains(endless.err, "it last read pin 9 as HIGH; the shafts have turned by -3"));
}

TEST_CASE("the public AccelStepper compiles unchanged, and ramps") {
  const char* const folder = std::getenv("BBSIM_ACCELSTEPPER");  // not in the repository
  if (folder == nullptr) return;
  const Folder into;
  const std::string ino =
      into.write("ramp.ino",
                 "#include <AccelStepper.h>\n#include <MultiStepper.h>\nAccelStepper "
                 "phi(AccelStepper::DRIVER, "
                 "2, 3), theta(AccelStepper::DRIVER, 4, 5);\nMultiStepper both;\nvoid setup() {\n"
                 "  both.addStepper(phi); both.addStepper(theta);\n"
                 "  phi.setMaxSpeed(1000); phi.setAcceleration(4000); phi.moveTo(120);\n"
                 "  theta.setMaxSpeed(1000); theta.setSpeed(300);\n}\n"
                 "void loop() { phi.run(); theta.runSpeed(); }\n");
  const Result made = bbsim({"sketch", ino, "-I", folder, "-o", into / "sketch.so"});
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  const std::string wiring =
      into.write("w.yaml", "steppers: {phi: {step: 2, dir: 3}, theta: {step: 4, dir: 5}}\n");
  std::vector<std::string> words{"run",   std::string(BBSIM_SOURCE_DIR) + "/tests/sketch/rig.yaml",
                                 "--set", "controller.library.file=" + (into / "sketch.so"),
                                 "--set", "controller.library.wiring=" + wiring,
                                 "--set", "time={end: 0.4, step: 10 ms}",
                                 "--set", "output.columns=[t, phi, theta]",
                                 "--set", "events={}"};
  words.insert(words.end(), stepper_rig.begin(), stepper_rig.end());
  words.insert(words.end(), {"-o", into / "run.csv", "-q"});
  const Result run = bbsim(words);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  // A triangle of 4000 steps/s^2 over 120 steps takes 0.346 s; halfway after 0.173 s.
  constexpr double step = 2 * 3.14159265358979324 / 3200;
  const std::vector<std::vector<double>> rows = numbers_of(into / "run.csv");
  CHECK(std::abs(rows[17][1] / step - 58) < 6);
  CHECK(std::abs(rows[40][1] / step - 120) < 1e-9);
  CHECK(std::abs(rows[40][2] / step - 120) < 3);
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
