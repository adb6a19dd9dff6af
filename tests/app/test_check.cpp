// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim check and bbsim columns.
#include <algorithm>
#include <sstream>
#include <string>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_check {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("check names the inputs of an open loop") {
  const Result result = bbsim({"check", config("fig2a.yaml")});
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "5 states: x, y, vx, vy, r*spin"));
  CHECK(contains(result.out, "no gimbal states"));
  CHECK(contains(result.out, "1001 rows"));
  CHECK(contains(result.out, "solver       radau, rtol 1e-08, atol 1e-10\n"));
  CHECK_FALSE(contains(result.out, "stiff:"));
  CHECK_FALSE(contains(result.out, "closed loop"));
  const Result reasons = bbsim({"check", config("fig2a.yaml"), "--verbose"});
  CHECK(contains(reasons.out, "rtol 1e-08, atol 1e-10\n             auto takes the method"));
  CHECK(contains(reasons.out, "not stiff: "));
}

TEST_CASE("check reports tumble as a planar scene once its y motion and spin are removed") {
  const std::string tumble = std::string(BBSIM_SOURCE_DIR) + "/tests/data/scenarios/tumble.yaml";
  CHECK(contains(bbsim({"check", tumble}).out, "5 states"));
  const Result planar =
      bbsim({"check", tumble, "--set", "ball.velocity=[0, 0]", "--set", "ball.spin=0"});
  CHECK(contains(planar.out, "2 states: x, vx"));
}

TEST_CASE("check prints the poles and warns of an unstable loop") {
  const Result stable = bbsim({"check", config("fig2b.yaml")});
  CHECK(stable.exit_code == 0);
  CHECK(contains(stable.out, "9 states"));
  CHECK(contains(stable.out, "8 poles about home"));
  CHECK_FALSE(contains(stable.out, "WARNING"));

  const Result unstable = bbsim({"check", config("fig2b-literal.yaml")});
  CHECK(unstable.exit_code == 0);
  CHECK(contains(unstable.out, "WARNING"));
  CHECK(contains(unstable.out, "unstable"));
}

TEST_CASE("check's verdict includes the age of the frames that a sampled controller sees") {
  const Folder folder;
  folder.write("camera.yaml",
               "ball: {radius: 0.01}\ntime: {end: 1, step: 0.1}\n"
               "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
               "controller: {drives: angle, pd: {kp: [[4, 0], [0, -4]], kv: [[2, 0], [0, -2]]}, "
               "reference: {point: [0, 0]}, sampling: {period: 0.02}, "
               "sensor: {period: 0.02, phase: 0}}\n");
  const auto check = [&](const std::string& set) {
    return bbsim({"check", "camera.yaml", "--set", set}, folder.path()).out;
  };
  CHECK(contains(check("controller.sensor.phase=0"), "stable: "));
  // A run with these values grows: each frame is 19 ms old.
  CHECK(contains(check("controller.sensor.phase=0.001"), "unstable about home: 4 of its 14 poles"));
  folder.write("slow.yaml",
               "ball: {radius: 0.01}\ntime: {end: 1, step: 0.1}\n"
               "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
               "controller: {drives: angle, pd: {kp: [[0.4, 0], [0, -0.4]], "
               "kv: [[0.3, 0], [0, -0.3]]}, reference: {point: [0, 0]}, "
               "sampling: {period: 0.02}, sensor: {period: 0.03, phase: 0.001}}\n");
  const Result slow = bbsim({"check", "slow.yaml"}, folder.path());
  CAPTURE(slow.out);
  CHECK(contains(slow.out, "poles of 3 sample periods, with 2 of the sensor's frames,"));
  CHECK(contains(slow.out, " in these periods"));
  CHECK(contains(slow.out, "none: the loop differs from sample to sample"));
  const Result never = bbsim(
      {"check", "slow.yaml", "--set", "controller.sensor.period=0.0314159265"}, folder.path());
  CHECK(contains(never.out, "without the sensor's own frames, as if each sample had one"));
  const Result linear = bbsim({"linearize", "slow.yaml", "-o", "-"}, folder.path());
  CHECK(linear.exit_code == 0);
  CHECK(contains(linear.err, "coincide with the samples again after 3 samples"));
}

TEST_CASE("an axis that no command moves and no reference leads is left out of the verdict") {
  const std::string part = GENERATE(
      "controller.sampling={period: 0.01, derivative_filter: 0.06}", "ball.rolling_radius=0.01",
      "ball.inertia_factor=0.667", "gimbal.mounting.phi_offset=0.01",
      "gimbal.servo.angle_limit=0.4", "ball={radius: 0.01, mass: 0.05, losses: {viscous: 1e-5}}");
  const auto check = [&](const std::string& more) {
    return bbsim({"check", config("beam.yaml"), "--set", part, "--set", more}).out;
  };
  CAPTURE(part);
  const std::string beam = check("ball.position.0=0.1");
  CHECK(contains(beam, "without y and theta"));
  CHECK(contains(beam, "\n             stable"));
  CHECK(contains(beam, "\n  phi        gain"));
  CHECK_FALSE(contains(beam, "WARNING"));
  CHECK_FALSE(contains(beam, "\n  theta      "));
  // Neither is left out if the reference is off it, or if phi moves the ball along it.
  if (part == "ball.rolling_radius=0.01") return;
  CHECK(contains(check("controller.reference.point.1=0.01"), "at the stability limit"));
  CHECK(contains(check("gimbal.mounting.yaw=0.1"), "at the stability limit"));
  CHECK(contains(check("controller.pd.kp.0.0=-1"), "unstable"));
}

TEST_CASE("check reports all problems of a scenario together, each with its place") {
  const Folder folder;
  folder.write("bad.yaml",
               "ball:\n"
               "  raduis: 0.01\n"
               "gimbal: {motion: {phi: 0}}\n"
               "time: {end: -1, step: 0.1}\n");
  const Result result = bbsim({"check", "bad.yaml"}, folder.path());
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK(contains(result.err, "bad.yaml:2:3: ball.raduis: unknown key; did you mean ball.radius?"));
  CHECK(contains(result.err, "ball.radius: missing"));
  CHECK(contains(result.err, "bad.yaml:4:13: time.end: found -1; allowed:"));
}

TEST_CASE("columns lists all columns with units") {
  const Result result = bbsim({"columns"});
  CHECK(result.exit_code == 0);
  for (const char* name : {"t",
                           "x",
                           "y",
                           "vx",
                           "vy",
                           "spin",
                           "gamma",
                           "phi",
                           "theta",
                           "phi_rate",
                           "theta_rate",
                           "phi_acceleration",
                           "theta_acceleration",
                           "x_reference",
                           "y_reference",
                           "normal_force",
                           "friction_force",
                           "friction_demand",
                           "torque_phi",
                           "torque_theta",
                           "energy",
                           "power"}) {
    CHECK(contains("\n" + result.out, "\n" + std::string(name) + " "));
  }
}

TEST_CASE("on a terminal, reports break between words below their text") {
  const Folder folder;
  const std::string shown = on_terminal({"check", config("rig.yaml")}, 80, folder.path(), 5);
  CAPTURE(shown);
  CHECK(contains(shown, "\r\n             "));
  std::size_t longest = 0;
  for (std::size_t begin = 0; begin < shown.size();) {
    const std::size_t end = std::min(shown.find("\r\n", begin), shown.size());
    longest = std::max(longest, end - begin);
    begin = end + 2;
  }
  CHECK(longest < 80);
  const std::string loop = on_terminal({"linearize", config("rig.yaml")}, 60, folder.path(), 5);
  CAPTURE(loop);
  // Poles and zeros that differ from zero by rounding are zero.
  CHECK_FALSE(contains(loop, "e-1"));
  // A pipe gets whole lines.
  CHECK(
      contains(bbsim({"check", config("rig.yaml")}).out, "; phase 35.7 deg at 4.81 rad/s; delay"));
}

TEST_CASE("help is at most 80 columns wide, and groups the commands") {
  const std::string help = bbsim({"--help"}).out;
  for (const char* group : {"\nRun and check:\n", "\nRigs:\n", "\nSweeps:\n", "\nAnalysis:\n",
                            "\nPictures:\n", "\nSetup:\n"}) {
    CHECK(contains(help, group));
  }
  for (const char* command :
       {"run",     "check",     "measure",   "compare",  "new",      "sketch", "design",
        "fit",     "tune",      "sweep",     "merge",    "plot",     "replay", "verify",
        "columns", "summarize", "linearize", "accuracy", "examples", "help"}) {
    CAPTURE(command);
    std::istringstream lines(bbsim({command, "--help"}).out);
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 80);
  }
}

TEST_CASE("angles too large for degrees are shown in radians, and lengths likewise in meters") {
  const Result result = bbsim({"check", config("step.yaml"), "--set", "controller.limit=1e308",
                               "--set", "controller.sensor.offset=[1e308, 0]"});
  CAPTURE(result.out);
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "within 1e+308 rad"));
  CHECK(contains(result.out, "off by 1e+308 m, 0 mm"));
  CHECK_FALSE(contains(result.out, "inf"));
}

TEST_CASE("every scenario of configs/ is valid and runs") {
  for (const char* name : {"fig2a", "fig2b", "incline", "beam", "hold", "recorded", "lissajous",
                           "waypoints", "traced", "rig", "step", "catch"}) {
    CAPTURE(name);
    const Folder folder;
    const std::string file = config(std::string(name) + ".yaml");
    CHECK(bbsim({"check", file}).exit_code == 0);
    const Result result = bbsim({"run", file}, folder.path());
    CAPTURE(result.err);
    CHECK(result.exit_code == 0);
  }
}

}  // namespace bbsim_test::test_check
