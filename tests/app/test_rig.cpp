// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenarios of real rigs, as a user runs them.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_rig {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::map<std::string, std::vector<double>> csv(const std::string& text) {
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line, cell; std::getline(lines, line);) {
    std::istringstream cells(line);
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (names.size() <= i) {
        names.push_back(cell);
      } else {
        columns[names[i]].push_back(std::stod(cell));
      }
    }
  }
  return columns;
}

// Root mean square of the distance from the reference after 5 s, in m.
double tracking_error(const std::string& text) {
  auto columns = csv(text);
  double sum = 0;
  std::size_t rows = 0;
  for (std::size_t i = 0; i < columns["t"].size(); ++i) {
    if (columns["t"][i] <= 5) continue;
    sum += std::pow(columns["x"][i] - columns["x_reference"][i], 2) +
           std::pow(columns["y"][i] - columns["y_reference"][i], 2);
    ++rows;
  }
  return std::sqrt(sum / static_cast<double>(rows));
}

}  // namespace

TEST_CASE("the rig tracks its circle; a delay beyond its margin is unstable, as check predicts") {
  const Folder folder;
  const std::string rig = config("rig.yaml");
  REQUIRE(bbsim({"run", rig, "-o", folder / "rig.csv"}).exit_code == 0);
  CHECK(tracking_error(folder.read("rig.csv")) < 5e-3);
  CHECK_FALSE(contains(bbsim({"check", rig}).out, "WARNING"));

  const std::vector<std::string> late = {"--set", "controller.sampling.delay=\"75 ms\"", "--set",
                                         "controller.sensor.delay=\"75 ms\""};
  std::vector<std::string> run = {"run", rig, "-o", folder / "late.csv"};
  run.insert(run.end(), late.begin(), late.end());
  REQUIRE(bbsim(run).exit_code == 0);
  CHECK(tracking_error(folder.read("late.csv")) > 10 * tracking_error(folder.read("rig.csv")));
  std::vector<std::string> check = {"check", rig};
  check.insert(check.end(), late.begin(), late.end());
  CHECK(contains(bbsim(check).out, "the sampled loop is unstable about home"));
}

TEST_CASE("check lists the parts that a scene uses and those that it does not") {
  const std::string rig = bbsim({"check", config("rig.yaml")}).out;
  for (const char* part : {"  servo ", "  law ", "  sampling ", "  sensor ", "  plate ",
                           "  events ", "  without    mounting errors, losses of the ball\n"}) {
    CAPTURE(part);
    CHECK(contains(rig, part));
  }
  const std::string plain = bbsim({"check", config("fig2b.yaml")}).out;
  CHECK(contains(
      plain,
      "  without    servo limits, dead band and backlash, sampling, sensor errors, mounting "
      "errors, losses of the ball, the plate's inertia, events\n"));
}

TEST_CASE("an event that stops a run appears in the message, the summary and the file") {
  const Folder folder;
  const Result result = bbsim({"run", config("falls.yaml"), "-o", folder / "falls.csv", "--summary",
                               folder / "falls.json"});
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err, "the contact point left the plate, at x = 0.16 m"));
  const auto summary = nlohmann::json::parse(folder.read("falls.json"));
  CHECK(summary.at("status") == "stopped");
  REQUIRE(summary.at("events").size() == 1);
  const auto& event = summary.at("events").front();
  CHECK(event.at("event") == "edge");
  CHECK(event.at("action") == "stop");
  CHECK(event.at("t") == summary.at("end_time"));
  CHECK(event.at("x").get<double>() == Approx(0.16).epsilon(1e-9));
  // The rows up to the event.
  const auto columns = csv(folder.read("falls.csv"));
  CHECK(columns.at("t").size() == summary.at("rows").get<std::size_t>());
  CHECK(columns.at("t").back() <= event.at("t").get<double>());
  CHECK(bbsim({"run", config("falls.yaml"), "-o", folder / "falls.h5"}).exit_code == 1);
  CHECK(bbsim({"compare", folder / "falls.csv", folder / "falls.h5"}).exit_code == 0);
}

TEST_CASE("the motors' peaks are in the summary if the plate's inertia is known") {
  const Folder folder;
  REQUIRE(
      bbsim({"run", config("rig.yaml"), "-o", folder / "rig.csv", "--summary", folder / "rig.json"})
          .exit_code == 0);
  const auto motors = nlohmann::json::parse(folder.read("rig.json")).at("motors");
  double peak = 0;
  const auto columns = csv(folder.read("rig.csv"));
  for (const double torque : columns.at("motor_torque_phi")) {
    peak = std::max(peak, std::abs(torque));
  }
  // Rows precede each command; the peak follows it.
  CHECK(motors.at("peak_torque_phi") > 1.4 * peak);
  CHECK(motors.at("peak_torque_phi") < 2 * peak);
  CHECK(motors.at("carries") == "ball and plate");
}

TEST_CASE("check reports that a loop has no poles") {
  const Result result =
      bbsim({"check", config("rig.yaml"), "--set", "controller.gravity_compensation.kv=1e308"});
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "its gains are too large"));
}

TEST_CASE("check remarks small margins of gain and phase, and the rig has none") {
  const auto said = [](const std::string& gains) {
    return bbsim({"check", config("rig.yaml"), "--set", "controller.gravity_compensation=" + gains})
        .out;
  };
  const std::string own = bbsim({"check", config("rig.yaml")}).out;
  CHECK(contains(own, "\nmargins "));
  CHECK_FALSE(contains(own, "remark"));
  CHECK(
      contains(said("{kp: 10, kv: 8}"), "\nremark       phi: small margins: gain 1.58 dB, phase"));
  const std::string only_gain = said("{kp: 5, kv: 5}");
  CHECK(contains(only_gain, "theta: small margins: gain 5.8"));
  CHECK_FALSE(contains(only_gain, "dB, phase"));
}

TEST_CASE("accuracy measures sampled rigs against CVODE") {
  const auto [name, more] = GENERATE(table<std::string, std::string>(
      {{"rig", "time.end=2"}, {"pushrod", "time.end=1"}, {"three-servos", "time.end=1"}}));
  CAPTURE(name);
  const Result result = bbsim({"accuracy", config(name + ".yaml"), "--methods", "radau", "--rtol",
                               "1e-8:1e-8", "--set", more, "--csv", "-"});
  REQUIRE(result.exit_code == 0);
  CHECK(contains(result.err, "m (CVODE's Adams method at rtol 1e-13)"));
  // An atol of 1e-10, and what hundreds of pieces add up to in a loop that damps errors.
  const std::string row = result.out.substr(result.out.find("radau,1e-08,1e-10,") + 18);
  CHECK(std::stod(row) < 1e-9);
  CHECK(contains(row, ",done\n"));
}

TEST_CASE("accuracy compares runs that an event stops up to the event") {
  const Result result = bbsim({"accuracy", config("falls.yaml"), "--methods", "radau", "--rtol",
                               "1e-8:1e-8", "--csv", "-"});
  CHECK(result.exit_code == 0);
  CHECK(contains(result.err, "an event stopped the run"));
  CHECK(contains(result.out, ",stopped\n"));
}

TEST_CASE("accuracy does not run your own controllers") {
  const Result result =
      bbsim({"accuracy", config("rig.yaml"), "--set",
             "controller={program: {command: [nothing]}, drives: angle, sampling: {period: "
             "20 ms}, reference: {point: [0, 0]}}"});
  CHECK(result.exit_code == 2);
  CHECK(contains(result.err, "controller: found one of your own"));
}

TEST_CASE("energy, work and losses balance in every scenario that follows them") {
  // Also over impacts: gears that engage, stops, and servos whose rate jumps with a command.
  const std::string plate = "plate.inertia=[2e-3, 3e-3, 5e-3]", losses = "ball.losses.viscous=1e-6";
  const auto [name, changes] = GENERATE_COPY(table<std::string, std::vector<std::string>>(
      {{"rolls-to-rest", {}},
       {"slides", {}},
       {"sags", {}},
       {"torque-lqr", {}},
       {"pushrod", {}},
       {"pushrod", {plate, "gimbal.servo.backlash=2 deg"}},
       {"pushrod", {plate, "gimbal.servo.angle_limit=8 deg"}},
       {"three-servos", {}},
       {"three-servos", {plate, "gimbal.servo.backlash=1 deg", "ball.losses.rolling=0.002"}},
       {"rig", {losses}},
       {"rig", {losses, "ball.losses.rolling=0.001", "gimbal.servo={time_constant: 0.03}"}}}));
  CAPTURE(name, changes);
  std::vector<std::string> run{"run",
                               config(name + ".yaml"),
                               "-q",
                               "-o",
                               "-",
                               "--set",
                               "output.columns=[t, total_energy, energy_lost, motor_work]",
                               "--set",
                               "solver.rtol=1e-10",
                               "--set",
                               "solver.atol=1e-12"};
  for (const std::string& change : changes) run.insert(run.end(), {"--set", change});
  const Result result = bbsim(run);
  CHECK(result.exit_code == (name == "slides" ? 1 : 0));  // it stops when the ball rests
  const auto columns = csv(result.out);
  const auto& energy = columns.at("total_energy");
  const auto& lost = columns.at("energy_lost");
  const auto& work = columns.at("motor_work");
  double first = 0, size = 0, gap = 0;
  REQUIRE(energy.size() > 100);
  for (std::size_t i = 0; i < energy.size(); ++i) {
    if (i == 0) first = energy[0] + lost[0] - work[0];
    size = std::max({size, std::abs(energy[i]), lost[i], std::abs(work[i])});
    gap = std::max(gap, std::abs(energy[i] + lost[i] - work[i] - first));
  }
  CAPTURE(gap, size);
  CHECK(size > 0);
  CHECK(gap < 1e-9 * size);
}

TEST_CASE("check lists the poles of plate, ball and motors, and what they leave out") {
  const Result loop = bbsim({"check", config("sags.yaml")});
  CHECK(loop.exit_code == 0);
  CHECK(contains(loop.out, "8 poles about home"));
  CHECK(contains(loop.out, "stable, without dry friction and limits"));
  CHECK(contains(loop.out, "position loop kp 4, kd 0.12, ki 0"));
  const Result regulator = bbsim({"check", config("torque-lqr.yaml")});
  CHECK(contains(regulator.out, "gain phi"));
  CHECK(contains(regulator.out, "the controller's"));
  const std::string open = std::string(BBSIM_SOURCE_DIR) + "/tests/data/scenarios/torque-open.yaml";
  const Result given = bbsim({"check", open});
  CHECK(contains(given.out, "plant        8 poles about home under no torque"));
  CHECK(contains(given.out, "given functions of time"));
}

TEST_CASE("check reports linkages, clocks and frames, and stops beyond a dead point") {
  const Result result = bbsim({"check", config("pushrod.yaml")});
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "servo_phi"));
  CHECK(contains(result.out, "push rod, (M54) to (M56), slope "));
  CHECK(contains(result.out, "the controller assumes the ratio at home"));
  CHECK(contains(result.out, "(the poles are those of the nominal period)"));
  CHECK(contains(result.out, "frames every 33.3 ms from 7 ms on"));
  CHECK(contains(result.out, "turned by 1.5 deg"));
  CHECK(contains(result.out, "dead_point (stops the run)"));
  CHECK_FALSE(contains(result.out, "lie beyond that"));
  const Result beyond =
      bbsim({"check", config("pushrod.yaml"), "--set", "gimbal.servo.angle_limit=3"});
  CHECK(contains(beyond.out, "WARNING: its stops at 171.887 deg lie beyond that"));
  const Result open = bbsim({"check", config("pushrod.yaml"), "--set", "gimbal.linkage.rod=1"});
  CHECK(open.exit_code == 2);
  CHECK(contains(open.err, "pushrod.yaml:"));
  CHECK(contains(open.err, "gimbal.linkage: found a rod of 1 m, with which the linkage does not"));

  const Result three = bbsim({"check", config("three-servos.yaml")});
  CHECK(three.exit_code == 0);
  CHECK(contains(three.out, "three servos, two tilts and a height"));
  CHECK(contains(three.out, "the shift of the plate's center is neglected"));
}

TEST_CASE("scenes with linkages and three servos run byte for byte the same") {
  for (const std::string name : {"pushrod", "three-servos", "pushed"}) {
    std::vector<std::string> run{"run", config((name == "pushed" ? "pushrod" : name) + ".yaml"),
                                 "-q", "--set", "time.end=4"};
    if (name == "pushed") {
      run.insert(run.end(),
                 {"--set", "ball.push={x: {sinusoid: {amplitude: 0.01, frequency: 3}}}"});
    }
    const auto made = [&](std::vector<std::string> more) {
      more.insert(more.begin(), run.begin(), run.end());
      const Result result = bbsim(more);
      CHECK(result.exit_code == 0);
      return result.out;
    };
    const std::string whole = made({"-o", "-"});
    const auto columns = csv(whole);
    CHECK(columns.at("servo_phi").size() == 201);
    double turned = 0;
    for (const double one : columns.at("servo_theta")) turned = std::max(turned, std::abs(one));
    CHECK(turned > 0.02);
    CHECK(made({"-o", "-"}) == whole);
  }
}

TEST_CASE("a run of a sliding ball reports when it rolls and when it rests") {
  const Result result = bbsim({"run", config("slides.yaml"), "-o", "-"});
  CHECK(contains(result.err, "noted: roll, once at t = 0.533974 s: the ball rolls again"));
  CHECK(contains(result.err, "the run stopped at t = 3.33288 s"));
  CHECK(contains(result.err, "events.rest is stop; note lets the run continue"));
}

TEST_CASE("a run with backlash of a micrometer's arc ends at each width") {
  const Folder folder;
  folder.write("scene.yaml", R"(
ball: {radius: 0.06788484106866718, velocity: [0.2, -0.20627556921775614], inertia_factor: 0.3}
gravity: 0.050339344099273264
controller:
  pid: {kv: [[0.068, 0], [0, -0.067]], kp: [[0.117, 0], [0, -0.117]], ki: [[0.12, 0.02], [0, -0.131]]}
  drives: angle
  reference: {circle: {radius: 0.00125, rate: -2.49}}
  sampling: {period: 0.015550203853004405, delay: 0.002723515714144792, jitter: 0.046654180691598116}
gimbal:
  servo: {natural_frequency: 89.74217781300791, damping: 0.043122094381324104, angle_limit: 0.10355188673516388,
          rate_limit: 1.0155454630550638, backlash: 1.0063409423953264e-06}
  start: {theta: -0.07389699332632566, phi: -0.01643683368793747, phi_rate: 0.02, theta_rate: -0.1301671296793474}
time: {end: 0.2, step: 0.02}
)");
  const std::vector<std::string> words{
      "sweep",     "scene.yaml", "--vary", "gimbal.servo.backlash=linear:1e-6:1.02e-6:200",
      "--measure", "end_x",      "-o",     "-",
      "-q"};
  const Result result = bbsim(words, folder.path());
  CAPTURE(result.out);
  CHECK(result.exit_code == 0);
  CHECK_FALSE(contains(result.out, ",failed,"));
  CHECK(bbsim({"run", "scene.yaml", "-q"}, folder.path()).exit_code == 0);
}

TEST_CASE("a push rod with a tiny arm under a bound on the error ends at its dead point") {
  const Folder folder;
  folder.write("scene.yaml", R"(
gravity: 0.0
ball: {radius: 0.007595010100005825, spin: 23.929232767321075}
controller:
  pd: {kv: [[0.8825, 0], [-0.00577, -1.4099]], kp: [[0.8787, -0.00576], [0, -1.046]]}
  drives: angle
  reference: {point: [0.011336428015401322, 0.028303567948590277]}
  limit: 0.04399576344605273
gimbal:
  servo: {natural_frequency: 22.909951277233493, damping: 1.4579541691807154, backlash: 9e-06}
  linkage: {horn: 0.16670521940592287, arm: 0.0005921103657281963, offset: [0.0016441341510459175, 0.0025211429173098918]}
time: {end: 3, step: 0.4}
solver: {error: "100 mm"}
)");
  const Result result = bbsim({"run", "scene.yaml", "-o", "-"}, folder.path());
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err, "is at a dead point"));
}

#ifdef BBSIM_PYTHON
TEST_CASE("legs turn on under a command that no pose fits, up to their dead point") {
  const Folder folder;
  folder.write(
      "far.py",
      "import json, math, sys\nsys.stdin.readline()\nprint('{\"protocol\": 1}', flush=True)\n"
      "for line in sys.stdin:\n    t = json.loads(line)['t']\n    g = 0.69 * min(2, t)\n"
      "    print(json.dumps({'command': [g * math.sin(3.19 * t), -g * math.sin(3.19 * t), "
      "0.3 * g * math.sin(3.35 * t)]}), flush=True)\n");
  folder.write("scene.yaml", R"(
ball: {radius: 0.02, position: [0.01, 0]}
gimbal:
  servo: {natural_frequency: 60.0, damping: 1.0}
  three_servos:
    {radius_base: 0.072, radius_plate: 0.0717, horn: 0.0466, rod: 0.0948, height: 0.1135,
     legs: [{angle: 0.026, joint_height: 0.0016},
            {angle: 1.967, radius_base: 0.0915, radius_plate: 0.0622, horn: 0.0572, rod: 0.121, height: 0.111, joint_height: -0.0047},
            {angle: 4.436, radius_base: 0.0562, radius_plate: 0.0711, horn: 0.0562, rod: 0.095, height: 0.1018, joint_height: -0.002}]}
controller:
  program: {command: [python3, far.py], timeout: "60 s"}
  drives: legs
  reference: {point: [0, 0]}
  sampling: {period: 0.02}
time: {end: 2.5, step: 0.005}
output: {columns: [t, phi, theta, servo_phi, phi_command, theta_command]}
)");
  for (const char* const method : {"auto", "bdf"}) {
    const Result result =
        bbsim({"run", "scene.yaml", "-o", "-", "--set", std::string("solver.method=") + method},
              folder.path());
    CAPTURE(method, result.err);
    CHECK(result.exit_code == 1);
    CHECK(contains(result.err, "is at a dead point"));
    CHECK(csv(result.out).at("phi").size() > 90);
  }
}
#endif

}  // namespace bbsim_test::test_rig
