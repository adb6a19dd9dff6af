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

// Root mean square of the distance from the reference after 5 s, in m.
double tracking_error(const std::string& text) {
  auto columns = columns_of(text);
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
  const std::string late =
      " @rig.yaml --set 'controller.sampling.delay=75 ms' --set 'controller.sensor.delay=75 ms'";
  const double error = tracking_error(expect(0, "run @rig.yaml -o -", folder).out);
  CHECK(error < 5e-3);
  CHECK(tracking_error(expect(0, "run -o -" + late, folder).out) > 10 * error);
  expect(0, "check @rig.yaml", folder, {}, {"!WARNING"});
  expect(0, "check" + late, folder, {}, {"the sampled loop is unstable about home"});
}

TEST_CASE("check lists the parts that a scene uses and those that it does not") {
  expect(0, call("check @rig.yaml"), {},
         {"  servo ", "  law ", "  sampling ", "  sensor ", "  plate ", "  events ",
          "  without    mounting errors, losses of the ball\n"});
  expect(0, call("check @fig2b.yaml"), {},
         {"  without    servo limits, dead band and backlash, sampling, sensor errors, mounting "
          "errors, losses of the ball, the plate's inertia, events\n"});
}

TEST_CASE("an event that stops a run appears in the message, the summary and the file") {
  const Folder folder;
  expect(1, "run @falls.yaml -o falls.csv --summary falls.json", folder,
         {"the contact point left the plate, at x = 0.16 m"});
  const auto summary = summary_of(folder, "falls.json");
  CHECK(summary.at("status") == "stopped");
  REQUIRE(summary.at("events").size() == 1);
  const auto& event = summary.at("events").front();
  CHECK(event.at("event") == "edge");
  CHECK(event.at("action") == "stop");
  CHECK(event.at("t") == summary.at("end_time"));
  CHECK(event.at("x").get<double>() == Approx(0.16).epsilon(1e-9));
  // The rows up to the event.
  const auto columns = columns_of(folder.read("falls.csv"));
  CHECK(columns.at("t").size() == summary.at("rows").get<std::size_t>());
  CHECK(columns.at("t").back() <= event.at("t").get<double>());
  expect(1, "run @falls.yaml -o falls.h5", folder);
  expect(0, "compare falls.csv falls.h5", folder);
}

TEST_CASE("the motors' peaks are in the summary if the plate's inertia is known") {
  const Folder folder;
  const Result run = expect(0, "run @rig.yaml -o - --summary rig.json", folder);
  const auto motors = summary_of(folder, "rig.json").at("motors");
  double peak = 0;
  const auto columns = columns_of(run.out);
  for (const double torque : columns.at("motor_torque_phi")) {
    peak = std::max(peak, std::abs(torque));
  }
  // Rows precede each command; the peak follows it.
  CHECK(motors.at("peak_torque_phi") > 1.4 * peak);
  CHECK(motors.at("peak_torque_phi") < 2 * peak);
  CHECK(motors.at("carries") == "ball and plate");
}

TEST_CASE("check remarks small margins of gain and phase, and gains without poles") {
  const Folder folder;
  expect(0, "check @rig.yaml", folder, {}, {"\nmargins ", "!remark"});
  const std::string gains = "check @rig.yaml --set 'controller.gravity_compensation=";
  expect(0, gains + "{kp: 10, kv: 8}'", folder, {},
         {"\nremark       phi: small margins: gain 1.58 dB, phase"});
  expect(0, gains + "{kp: 5, kv: 5}'", folder, {},
         {"theta: small margins: gain 5.8", "!dB, phase"});
  expect(0, gains + "{kp: 10, kv: 1e308}'", folder, {}, {"its gains are too large"});
}

TEST_CASE("accuracy measures sampled rigs against CVODE") {
  const auto [name, more] = GENERATE(table<std::string, std::string>(
      {{"rig", "time.end=2"}, {"pushrod", "time.end=1"}, {"three-servos", "time.end=1"}}));
  CAPTURE(name);
  const Result result =
      expect(0,
             call("accuracy @" + name + ".yaml --methods radau --rtol 1e-8:1e-8 --set '" + more +
                  "' --csv -"),
             {"m (CVODE's Adams method at rtol 1e-13)"});
  // An atol of 1e-10, and what hundreds of pieces add up to in a loop that damps errors.
  const std::string row = result.out.substr(result.out.find("radau,1e-08,1e-10,") + 18);
  CHECK(std::stod(row) < 1e-9);
  CHECK(contains(row, ",done\n"));
}

TEST_CASE("accuracy compares stopped runs up to the event, and runs no controllers of your own") {
  expect(0, call("accuracy @falls.yaml --methods radau --rtol 1e-8:1e-8 --csv -"),
         {"an event stopped the run"}, {",stopped\n"});
  expect(2,
         call("accuracy @rig.yaml --set 'controller={program: {command: [nothing]}, drives: "
              "angle, sampling: {period: 20 ms}, reference: {point: [0, 0]}}'"),
         {"controller: found one of your own"});
}

TEST_CASE("energy, work and losses balance in every scenario that follows them") {
  // Also over impacts: gears that engage, stops, and servos whose rate jumps with a command.
  const std::string plate = " --set 'plate.inertia=[2e-3, 3e-3, 5e-3]'";
  const std::string losses = " --set ball.losses.viscous=1e-6";
  const auto [name, changes] = GENERATE_COPY(table<std::string, std::string>(
      {{"rolls-to-rest", ""},
       {"slides", ""},
       {"sags", ""},
       {"torque-lqr", ""},
       {"pushrod", ""},
       {"pushrod", plate + " --set 'gimbal.servo.backlash=2 deg'"},
       {"pushrod", plate + " --set 'gimbal.servo.angle_limit=8 deg'"},
       {"three-servos", ""},
       {"three-servos",
        plate + " --set 'gimbal.servo.backlash=1 deg' --set ball.losses.rolling=0.002"},
       {"rig", losses},
       {"rig", losses + " --set ball.losses.rolling=0.001 --set "
                        "'gimbal.servo={time_constant: 0.03}'"}}));
  const Result result = call("run @" + name +
                             ".yaml -q -o - --set 'output.columns=[t, total_energy, energy_lost, "
                             "motor_work]' --set solver.rtol=1e-10 --set solver.atol=1e-12" +
                             changes);
  // It stops when the ball rests.
  const auto columns = columns_of(expect(name == "slides" ? 1 : 0, result).out);
  const auto& energy = columns.at("total_energy");
  const auto& lost = columns.at("energy_lost");
  const auto& work = columns.at("motor_work");
  const double first = energy[0] + lost[0] - work[0];
  double size = 0, gap = 0;
  REQUIRE(energy.size() > 100);
  for (std::size_t i = 0; i < energy.size(); ++i) {
    size = std::max({size, std::abs(energy[i]), lost[i], std::abs(work[i])});
    gap = std::max(gap, std::abs(energy[i] + lost[i] - work[i] - first));
  }
  CAPTURE(name, changes, gap, size);
  CHECK(size > 0);
  CHECK(gap < 1e-9 * size);
}

TEST_CASE("check lists the poles of plate, ball and motors, and what they leave out") {
  expect(0, call("check @sags.yaml"), {},
         {"8 poles about home", "stable, without dry friction and limits",
          "position loop kp 4, kd 0.12, ki 0"});
  expect(0, call("check @torque-lqr.yaml"), {}, {"gain phi", "the controller's"});
  expect(0, call("check '" BBSIM_SOURCE_DIR "/tests/data/scenarios/torque-open.yaml'"), {},
         {"plant        8 poles about home under no torque", "given functions of time"});
}

TEST_CASE("check reports linkages, clocks and frames, and stops beyond a dead point") {
  expect(
      0, call("check @pushrod.yaml"), {},
      {"servo_phi", "push rod, (M54) to (M56), slope ", "the controller assumes the ratio at home",
       "(the poles are those of the nominal period)", "frames every 33.3 ms from 7 ms on",
       "turned by 1.5 deg", "dead_point (stops the run)", "!lie beyond that"});
  expect(0, call("check @pushrod.yaml --set gimbal.servo.angle_limit=3"), {},
         {"WARNING: its stops at 171.887 deg lie beyond that"});
  expect(2, call("check @pushrod.yaml --set gimbal.linkage.rod=1"),
         {"pushrod.yaml:", "gimbal.linkage: found a rod of 1 m, with which the linkage does not"});

  expect(0, call("check @three-servos.yaml"), {},
         {"three servos, two tilts and a height", "the shift of the plate's center is neglected"});
}

TEST_CASE("scenes with linkages and three servos run byte for byte the same") {
  const std::string scene =
      GENERATE("@pushrod.yaml", "@three-servos.yaml",
               "@pushrod.yaml --set 'ball.push={x: {sinusoid: {amplitude: 0.01, frequency: 3}}}'");
  const std::string line = "run " + scene + " -q --set time.end=4 -o -";
  const std::string whole = expect(0, call(line)).out;
  const auto columns = columns_of(whole);
  CHECK(columns.at("servo_phi").size() == 201);
  double turned = 0;
  for (const double angle : columns.at("servo_theta")) turned = std::max(turned, std::abs(angle));
  CHECK(turned > 0.02);
  CHECK(call(line).out == whole);
}

TEST_CASE("a run of a sliding ball reports when it rolls and when it rests") {
  expect(1, call("run @slides.yaml -o -"),
         {"noted: roll, once at t = 0.533974 s: the ball rolls again",
          "the run stopped at t = 3.33288 s", "events.rest is stop; note lets the run continue"});
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
  expect(0,
         "sweep scene.yaml --vary gimbal.servo.backlash=linear:1e-6:1.02e-6:200 --measure end_x "
         "-o - -q",
         folder, {}, {"!,failed,"});
  expect(0, "run scene.yaml -q", folder);
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
  expect(1, "run scene.yaml -o -", folder, {"is at a dead point"});
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
  for (const std::string method : {"auto", "bdf"}) {
    const Result result = expect(1, "run scene.yaml -o - --set solver.method=" + method, folder,
                                 {"is at a dead point"});
    CHECK(columns_of(result.out).at("phi").size() > 90);
  }
}
#endif

}  // namespace bbsim_test::test_rig
