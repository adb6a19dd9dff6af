// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sketches of sketches/, each in a style that people publish, run unchanged and balance the
// ball.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "catch.hpp"
#include "sketch/sketch.hpp"

namespace bbsim_test::test_styles {

namespace {

struct Style {
  std::string name;
  std::string settings{};
};

const std::string stepper_motors =
    " --set 'gimbal.servo={stepper: {steps: 200, microsteps: 16}}' --set "
    "'controller.sampling.period=1 ms'";
const std::string three_legs =
    " --set 'gimbal.three_servos={radius_base: 10 cm, radius_plate: 10 cm, horn: 5 cm, rod: 12 cm, "
    "height: 12 cm}' --set controller.drives=legs";

// Inverse kinematics need a plate with rods; commands are then the servos' angles.
const Style styles[] = {
    {"pid_touch"},
    {"busy_wait"},
    {"inverse_kinematics",
     " --set 'gimbal.linkage={horn: 2.4 cm, arm: 6 cm, offset: [-1.6 cm, 7 cm]}' --set "
     "'gimbal.servo.angle_limit=60 deg' --set 'controller.limit=50 deg'"},
    {"camera"},
    {"kalman"},
    {"calibration"},
    {"forward"},
    {"steppers", stepper_motors},
    {"stepper_legs", stepper_motors + three_legs},
    {"pca_legs", three_legs},
    {"beam", " --set 'ball.position=[-5 cm, 0]'"},
};

const std::string balances = " --expect 'rms_x from 7 s < 0.004' --expect 'rms_y from 7 s < 0.004'";

}  // namespace

TEST_CASE(
    "sketches in the style of published ones run unchanged, balance, and repeat byte for byte") {
  const Style& style = GENERATE(from_range(std::begin(styles), std::end(styles)));
  const Sketch sketch(style.name);
  // Without noise, only the limit cycle from the screen's resolution remains.
  const Result first = expect(0, sketch.run(style.settings + " -q" + balances));
  for (int i = 0; i < 3; ++i) CHECK(sketch.run(style.settings + " -q").out == first.out);
}

TEST_CASE("pulses turn a stepper by microsteps, at a constant rate from sample to sample") {
  // 100 steps forward at 1 kHz after 10 ms, then 20 back, one of them while the driver is off.
  const Sketch sketch(
      "int n = 0;\nvoid setup() { pinMode(2, OUTPUT); pinMode(3, OUTPUT); pinMode(8, OUTPUT); }\n"
      "void loop() {\n  if (millis() < 10) return;\n  while (n < 120) {\n"
      "    digitalWrite(3, n < 100 ? HIGH : LOW); digitalWrite(8, n == 119 ? HIGH : LOW);\n"
      "    digitalWrite(2, HIGH); digitalWrite(2, LOW); n++; delayMicroseconds(984);\n  }\n}\n",
      "steppers: {phi: {step: 2, dir: 3, enable: 8}}\n");
  const Result run = expect(
      0, sketch.run("-q --set 'gimbal.servo={stepper: {steps: 200, microsteps: 8, gear: 2}}' --set "
                    "'controller.sampling.period=2 ms' --set 'time={end: 0.2, step: 1 ms}' --set "
                    "events={} --set 'output.columns=[t, phi, phi_rate, phi_believed]' --expect "
                    "'max_phi < 0.1964' --expect 'max_phi > 0.1963'"));
  constexpr double step = 2 * 3.14159265358979324 / (200 * 8 * 2);
  auto columns = columns_of(run.out);
  const std::vector<double>& phi = columns["phi"];
  REQUIRE(phi.size() == 201);
  CHECK(phi == columns["phi_believed"]);
  // At the samples the shaft is where the pulses have brought it. The board's clock shows 2 ms at
  // t = 0.
  CHECK(std::abs(phi[60] - 52 * step) < 1.01 * step);
  CHECK(std::abs(columns["phi_rate"][60] - 1000 * step) < 1e-6);
  CHECK(std::abs(phi[200] - 81 * step) < 1e-12);
}

TEST_CASE("check finds the gains of a sketch that pulses steppers after its ramp") {
  const Sketch sketch("steppers");
  const Result check = expect(0, sketch.on_rig("check", stepper_motors));
  for (const std::string command : {"phi", "theta"}) {
    const std::string before = command + ": pushes the ball towards the reference; gain ";
    const std::size_t at = check.out.find(before);
    REQUIRE(at != std::string::npos);
    // 0.6 degrees for each cm, in whole microsteps of 0.11 degrees.
    const double gain = std::abs(std::strtod(check.out.c_str() + at + before.size(), nullptr));
    CHECK(std::abs(gain - 1.047) < 0.1);
  }
}

TEST_CASE("a wiring and a scenario that disagree on a stepper are refused") {
  const auto [wiring, settings, told] = GENERATE_COPY(table<std::string, std::string, std::string>({
      {"steppers: {phi: {step: 2, dir: 3}}\n", "",
       "wires a stepper where the scenario has a servo"},
      {"servos: {phi: {pin: 2}}\n", stepper_motors,
       "wires a servo where the scenario has a stepper"},
      {"servos: {phi: {pin: 2}}\n", stepper_motors + " --set gimbal.servo.rate_limit=1",
       "the sketch's pulses make the ramp"},
      // Homing ends elsewhere than the run begins.
      {"steppers: {phi: {step: 2, dir: 3, start: \"10 deg\"}}\n", stepper_motors,
       "the motor phi stands at 10 deg"},
  }));
  const Sketch sketch("void setup() {}\nvoid loop() {}\n", wiring);
  expect(2, sketch.run(settings), {told});
}

TEST_CASE("homing that never ends is refused with its angle") {
  const Sketch never(
      "void setup() {\n  pinMode(2, OUTPUT); pinMode(3, OUTPUT); pinMode(9, INPUT_PULLUP);\n"
      "  while (digitalRead(9) == HIGH) { digitalWrite(2, HIGH); digitalWrite(2, LOW); delay(20); "
      "}\n"
      "}\nvoid loop() {}\n",
      "steppers: {phi: {step: 2, dir: 3, start: 0, home: {pin: 9, angle: \"10 deg\"}}}\n");
  expect(1, never.run(stepper_motors),
         {"it last read pin 9 as HIGH; the shafts have turned by -3"});
}

TEST_CASE("the public AccelStepper compiles unchanged, and ramps") {
  const char* const folder = std::getenv("BBSIM_ACCELSTEPPER");  // not in the repository
  if (folder == nullptr) return;
  const Sketch sketch(
      "#include <AccelStepper.h>\n#include <MultiStepper.h>\nAccelStepper "
      "phi(AccelStepper::DRIVER, "
      "2, 3), theta(AccelStepper::DRIVER, 4, 5);\nMultiStepper both;\nvoid setup() {\n"
      "  both.addStepper(phi); both.addStepper(theta);\n"
      "  phi.setMaxSpeed(1000); phi.setAcceleration(4000); phi.moveTo(120);\n"
      "  theta.setMaxSpeed(1000); theta.setSpeed(300);\n}\n"
      "void loop() { phi.run(); theta.runSpeed(); }\n",
      "steppers: {phi: {step: 2, dir: 3}, theta: {step: 4, dir: 5}}\n", false);
  expect(0, "sketch own.ino -o sketch.so -I " + std::string(folder), sketch);
  const Result run = expect(0, sketch.run("--set 'time={end: 0.4, step: 10 ms}' --set "
                                          "'output.columns=[t, phi, theta]' --set events={}" +
                                          stepper_motors));
  // A triangle of 4000 steps/s^2 over 120 steps takes 0.346 s; halfway after 0.173 s.
  constexpr double step = 2 * 3.14159265358979324 / 3200;
  auto columns = columns_of(run.out);
  CHECK(std::abs(columns["phi"][17] / step - 58) < 6);
  CHECK(std::abs(columns["phi"][40] / step - 120) < 1e-9);
  CHECK(std::abs(columns["theta"][40] / step - 120) < 3);
}

TEST_CASE("a hundred runs of a sketch give the same bytes", "[slow]") {
  const Sketch sketch(GENERATE("pid_touch", "camera"));
  const std::string first = sketch.run("-q").out;
  CHECK(first.size() > 10000);
  for (int i = 0; i < 100; ++i) REQUIRE(sketch.run("-q").out == first);
}

TEST_CASE("a state machine moves the ball around its square and prints columns") {
  expect(0, Sketch("square").run(
                "--set time.end=20 --set 'output.columns=[t, x, y, target_x, target_y]' --expect "
                "'max_x from 4 s > 0.045' --expect 'min_x from 4 s < -0.045' --expect 'max_y from "
                "4 s > 0.045' --expect 'min_y from 4 s < -0.045' --expect 'max_target_x >= 50' "
                "--expect 'min_target_y <= -50'"));
}

TEST_CASE("threads of a sweep have their own boards") {
  const Sketch sketch("pid_touch");
  const std::string cases =
      " --vary ball.position.0=list:-0.06,-0.03,0,0.03,0.05,0.07 --measure end_x,max_x,min_x -o - "
      "-q -j ";
  const Result alone = expect(0, sketch.on_rig("sweep", cases + "1"));
  CHECK(sketch.on_rig("sweep", cases + "4").out == alone.out);
  const Result single =
      sketch.on_rig("run", " --set ball.position.0=0.05 --measure end_x -q -o run.csv");
  CHECK(rows(alone.out).at(5).at(5) == rows(single.out).at(1).at(1));
}

TEST_CASE("the public PID_v1 compiles unchanged") {
  const char* const folder = std::getenv("BBSIM_PID_V1");  // not in the repository
  if (folder == nullptr) return;
  const Sketch sketch("pid_touch");
  expect(0,
         "sketch %tests/sketch/sketches/pid_touch/pid_touch.ino -o sketch.so -I " +
             std::string(folder),
         sketch);
  expect(0, sketch.run("-q" + balances));
}

}  // namespace bbsim_test::test_styles
