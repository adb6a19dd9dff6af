// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim check and bbsim columns.
#include <algorithm>
#include <string>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_check {

TEST_CASE("check names the inputs of an open loop") {
  expect(0, call("check @fig2a.yaml"), {},
         {"5 states: x, y, vx, vy, r*spin", "no gimbal states", "1001 rows",
          "solver       radau, rtol 1e-08, atol 1e-10\n", "!stiff:", "!closed loop"});
  expect(0, call("check @fig2a.yaml --verbose"), {},
         {"rtol 1e-08, atol 1e-10\n             auto takes the method", "not stiff: "});
}

TEST_CASE("check names the stops of known commands") {
  const Folder folder;
  folder.write("a.csv", "t,phi\n0,0\n1,0.01\n2,0\n4,0\n");
  folder.write("rig.yaml",
               "ball: {radius: 0.01}\ntime: {end: 3, step: 0.1}\n"
               "gimbal: {servo: {time_constant: 0.05}}\ncontroller: {drives: angle, sampling: "
               "{period: 0.02}, commands: {phi: {table: {file: a.csv, time: t, value: phi}}}}\n");
  expect(0, "check rig.yaml", folder, {}, {"2 knots of the commands"});
}

TEST_CASE("check reports tumble as a planar scene once its y motion and spin are removed") {
  const std::string tumble = "check %tests/data/scenarios/tumble.yaml";
  expect(0, call(tumble), {}, {"5 states"});
  expect(0, call(tumble + " --set 'ball.velocity=[0, 0]' --set ball.spin=0"), {},
         {"2 states: x, vx"});
}

TEST_CASE("check prints the poles and warns of an unstable loop") {
  expect(0, call("check @fig2b.yaml"), {}, {"9 states", "8 poles about home", "!WARNING"});
  expect(0, call("check @fig2b-literal.yaml"), {}, {"WARNING", "unstable"});
}

TEST_CASE("check's verdict includes the age of the frames that a sampled controller sees") {
  const Folder folder;
  const std::string rig =
      "ball: {radius: 0.01}\ntime: {end: 1, step: 0.1}\n"
      "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
      "controller: {drives: angle, reference: {point: [0, 0]}, sampling: {period: 0.02}, ";
  folder.write("camera.yaml", rig +
                                  "pd: {kp: [[4, 0], [0, -4]], kv: [[2, 0], [0, -2]]}, "
                                  "sensor: {period: 0.02, phase: 0}}\n");
  expect(0, "check camera.yaml", folder, {}, {"stable: "});
  // A run with these values grows: each frame is 19 ms old.
  expect(0, "check camera.yaml --set controller.sensor.phase=0.001", folder, {},
         {"unstable about home: 4 of its 14 poles"});
  folder.write("slow.yaml", rig +
                                "pd: {kp: [[0.4, 0], [0, -0.4]], kv: [[0.3, 0], [0, -0.3]]}, "
                                "sensor: {period: 0.03, phase: 0.001}}\n");
  expect(0, "check slow.yaml", folder, {},
         {"poles of 3 sample periods, with 2 of the sensor's frames,", " in these periods",
          "none: the loop differs from sample to sample"});
  expect(0, "check slow.yaml --set controller.sensor.period=0.0314159265", folder, {},
         {"without the sensor's own frames, as if each sample had one"});
  expect(0, "linearize slow.yaml -o -", folder,
         {"coincide with the samples again after 3 samples"});
}

TEST_CASE("an axis that no command moves and no reference leads is left out of the verdict") {
  const std::string part = GENERATE(
      "controller.sampling={period: 0.01, derivative_filter: 0.06}", "ball.rolling_radius=0.01",
      "ball.inertia_factor=0.667", "gimbal.mounting.phi_offset=0.01",
      "gimbal.servo.angle_limit=0.4", "ball={radius: 0.01, mass: 0.05, losses: {viscous: 1e-5}}");
  const std::string check = "check @beam.yaml --set '" + part + "' --set ";
  expect(0, call(check + "ball.position.0=0.1"), {},
         {"without y and theta", "\n             stable", "\n  phi        gain", "!WARNING",
          "!\n  theta      "});
  // Neither is left out if the reference is off it, or if phi moves the ball along it.
  if (part == "ball.rolling_radius=0.01") return;
  for (const auto& [key, told] :
       {std::pair<std::string, std::string>{"controller.reference.point.1=0.01",
                                            "at the stability limit"},
        {"gimbal.mounting.yaw=0.1", "at the stability limit"},
        {"controller.pd.kp.0.0=-1", "unstable"}}) {
    expect(0, call(check + key), {}, {told});
  }
}

TEST_CASE("check reports all problems of a scenario together, each with its place") {
  const Folder folder;
  folder.write("bad.yaml",
               "ball:\n"
               "  raduis: 0.01\n"
               "gimbal: {motion: {phi: 0}}\n"
               "time: {end: -1, step: 0.1}\n");
  const Result result =
      expect(2, "check bad.yaml", folder,
             {"bad.yaml:2:3: ball.raduis: unknown key; did you mean ball.radius?",
              "ball.radius: missing", "bad.yaml:4:13: time.end: found -1; allowed:"});
  CHECK(result.out.empty());
}

TEST_CASE("columns lists all columns with units") {
  const std::string listed = "\n" + expect(0, call("columns")).out;
  for (const std::string& name :
       split("t x y vx vy spin gamma phi theta phi_rate theta_rate phi_acceleration "
             "theta_acceleration x_reference y_reference normal_force friction_force "
             "friction_demand torque_phi torque_theta energy power",
             ' ')) {
    CAPTURE(name);
    CHECK(contains(listed, "\n" + name + " "));
  }
}

TEST_CASE("on a terminal, reports break between words below their text") {
  const Folder folder;
  const std::string shown = on_terminal("check @rig.yaml", 80, folder, 5);
  CAPTURE(shown);
  CHECK(contains(shown, "\r\n             "));
  for (const std::string& line : lines(shown)) CHECK(line.size() <= 80);  // with its "\r"
  const std::string loop = on_terminal("linearize @rig.yaml", 60, folder, 5);
  CAPTURE(loop);
  // Poles and zeros that differ from zero by rounding are zero.
  CHECK_FALSE(contains(loop, "e-1"));
  // A pipe gets whole lines.
  expect(0, "check @rig.yaml", folder, {}, {"; phase 35.7 deg at 4.81 rad/s; delay"});
}

TEST_CASE("angles too large for degrees are shown in radians, and lengths likewise in meters") {
  expect(0,
         call("check @step.yaml --set controller.limit=1e308 --set "
              "'controller.sensor.offset=[1e308, 0]'"),
         {}, {"within 1e+308 rad", "off by 1e+308 m, 0 mm", "!inf"});
}

TEST_CASE("every scenario of configs/ is valid and runs") {
  const Folder folder;
  for (const std::string& name :
       split("fig2a fig2b incline beam hold recorded lissajous waypoints traced rig step catch",
             ' ')) {
    expect(0, "check @" + name + ".yaml", folder);
    expect(0, "run @" + name + ".yaml", folder);
  }
}

}  // namespace bbsim_test::test_check
