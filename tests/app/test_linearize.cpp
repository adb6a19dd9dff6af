// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim linearize and its files, read by their target programs if those are installed.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"
#include "shell.hpp"

namespace bbsim_test::test_linearize {

using nlohmann::json;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("linearize writes A, B, C, D, names and poles as JSON") {
  const Folder folder;
  const Result result =
      bbsim({"linearize", config("fig2b.yaml"), "--plant", "-o", "plant.json"}, folder.path());
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  const json plant = json::parse(folder.read("plant.json"));
  CHECK(plant["states"] == json({"x", "y", "vx", "vy", "phi", "theta", "phi_rate", "theta_rate"}));
  CHECK(plant["inputs"] == json({"phi_command", "theta_command"}));
  CHECK(plant["input_units"] == json({"rad", "rad"}));
  CHECK(plant["outputs"] == json({"x", "y"}));
  CHECK(plant["period"].is_null());
  REQUIRE(plant["A"].size() == 8);
  CHECK(plant["A"][0] == json({0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  CHECK(plant["B"].size() == 8);
  CHECK(plant["B"][6][0].get<double>() == Approx(100).epsilon(1e-15));  // omega_n^2
  CHECK(plant["C"] ==
        json({{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}}));
  CHECK(plant["D"] == json({{0.0, 0.0}, {0.0, 0.0}}));
  CHECK(plant["poles"].size() == 8);
  CHECK(plant["zeros"].size() == 4);

  const Result loop = bbsim({"linearize", config("rig.yaml"), "-o", "-"});
  REQUIRE(loop.exit_code == 0);
  const json sampled = json::parse(loop.out);
  CHECK(sampled["period"] == 0.02);
  CHECK(sampled["poles"].size() == sampled["states"].size());
  CHECK(sampled["margins"]["phi_command"]["gain"].get<double>() > 1);
  CHECK(sampled["bandwidth"]["x"].is_null());  // the law uses the reference's accelerations
  CHECK(sampled["feedback_bandwidth"]["x"].is_number());
}

TEST_CASE("linearize accepts a time of the run or an equilibrium") {
  const Result at_time =
      bbsim({"linearize", config("fig2b.yaml"), "--at", "2 s", "-o", "-", "--plant"});
  REQUIRE(at_time.exit_code == 0);
  const json moving = json::parse(at_time.out);
  CHECK(moving["at"] == "t = 2 s");
  CHECK(moving["states"].size() == 9);  // on a turning plane, spin matters
  const Result at_start =
      bbsim({"linearize", config("rig.yaml"), "--at", "0", "-o", "-", "--sampled"});
  REQUIRE(at_start.exit_code == 0);
  const Result rest = bbsim({"linearize", config("step.yaml"), "--at", "equilibrium"});
  CHECK(rest.exit_code == 0);
  CHECK(contains(rest.out, "about equilibrium"));
  CHECK(contains(rest.out, "margins"));

  CHECK(bbsim({"linearize", config("fig2b.yaml"), "--at", "1000 s"}).exit_code == 2);
  CHECK(bbsim({"linearize", config("fig2b.yaml"), "--at", "somewhere"}).exit_code == 2);
  CHECK(bbsim({"linearize", config("fig2a.yaml"), "--loop"}).exit_code == 2);
  CHECK(bbsim({"linearize", config("fig2b.yaml"), "--sampled"}).exit_code == 2);
  CHECK(bbsim({"linearize", config("fig2b.yaml"), "--plant", "--loop"}).exit_code == 2);
  CHECK(bbsim({"linearize", config("fig2b.yaml"), "-o", "plant.txt"}).exit_code == 2);
  // The law as printed blows up before.
  CHECK(bbsim({"linearize", config("fig2b-literal.yaml"), "--at", "10"}).exit_code == 1);
}

TEST_CASE("linearize's files contain what their readers expect") {
  const Folder folder;
  for (const char* name : {"loop.m", "loop.py", "loop.csv"}) {
    REQUIRE(bbsim({"linearize", config("rig.yaml"), "-o", name}, folder.path()).exit_code == 0);
  }
  std::istringstream csv(folder.read("loop.csv"));
  std::string header, first;
  std::getline(csv, header);
  std::getline(csv, first);
  CHECK(header.starts_with("row,x,y,vx,vy,phi,theta,phi_rate,theta_rate,"));
  CHECK(contains(header, ",x_reference,y_reference"));
  CHECK(first.starts_with("x_next,"));
  CHECK(contains(folder.read("loop.m"), "sys = ss(A, B, C, D, period);"));
  CHECK(contains(folder.read("loop.py"), "control.ss(A, B, C, D, period)"));
  // Python itself reads the module; a stand-in for numpy's array is used if numpy is missing.
  const Result python = shell(
      "command -v python3 >/dev/null || exit 0\n"
      "python3 - <<'END'\n"
      "import sys, types\n"
      "try:\n"
      "    import numpy\n"
      "except ImportError:\n"
      "    numpy = None\n"
      "    sys.modules['numpy'] = types.SimpleNamespace(array=lambda rows: rows)\n"
      "import loop\n"
      "assert len(loop.A) == len(loop.states) == len(loop.B), len(loop.A)\n"
      "assert len(loop.C) == len(loop.outputs) == 2\n"
      "assert len(loop.D[0]) == len(loop.inputs)\n"
      "assert loop.period == 0.02\n"
      "if numpy:\n"
      "    assert max(abs(numpy.linalg.eigvals(loop.A))) < 1\n"
      "END\n",
      folder.path());
  CAPTURE(python.err);
  CHECK(python.exit_code == 0);
  const Result octave = shell(
      "command -v octave-cli >/dev/null || exit 0\n"
      "octave-cli --norc --eval 'loop; assert(max(abs(eig(A))) < 1); assert(size(B, 2) == "
      "numel(inputs))'\n",
      folder.path());
  CAPTURE(octave.err);
  CHECK(octave.exit_code == 0);
}

TEST_CASE("no zero that linearize writes or prints has a sign") {
  const Folder folder;
  for (const char* name : {"three-servos.yaml", "torque-lqr.yaml"}) {
    for (const char* kind : {"--plant", "--loop"}) {
      for (const char* file : {"all.m", "all.py", "all.csv", "all.json"}) {
        REQUIRE(bbsim({"linearize", config(name), kind, "-o", file}, folder.path()).exit_code == 0);
      }
      const Result found =
          shell("grep -nE '(^|[^0-9e])-0(\\.0)?([^0-9.]|$)' all.*; $BBSIM linearize " +
                    config(name) + " " + kind + " | grep -nE '(^| )-0([^0-9.]|$)'",
                folder.path());
      CAPTURE(name, kind, found.out);
      CHECK(found.out.empty());
    }
  }
}

TEST_CASE("linearize overwrites no input") {
  const Folder folder;
  const Result same =
      shell("cp " + config("fig2b.yaml") + " scene.csv; $BBSIM linearize scene.csv -o scene.csv",
            folder.path());
  CHECK(same.exit_code == 2);
}

TEST_CASE("check prints the margins of a stable loop") {
  const Result stable = bbsim({"check", config("fig2b.yaml")});
  CHECK(contains(stable.out, "margins"));
  CHECK(contains(stable.out, "phase "));
  CHECK(contains(stable.out, "bandwidth"));
  CHECK_FALSE(contains(bbsim({"check", config("fig2b-literal.yaml")}).out, "margins"));
  CHECK_FALSE(contains(bbsim({"check", config("fig2a.yaml")}).out, "margins"));
}

TEST_CASE("margins at the lowest and highest frequencies, and of a lead, are reported") {
  const Folder folder;
  const std::string about = "ball: {radius: 0.02, mass: 0.1}\ntime: {end: 1, step: 0.1}\n";
  folder.write("half-rate.yaml",
               about +
                   "gimbal: {servo: {natural_frequency: 55, damping: 0.7}}\n"
                   "controller: {state_feedback: {gain: [[0.66, 0, 0.61, 0, 0.1, 0, 0.02, 0], "
                   "[0, -0.66, 0, -0.61, 0, 0.1, 0, 0.02]]}, drives: angle, "
                   "reference: {point: [0, 0]}, sampling: {period: 0.026}}\n");
  const Result fast = bbsim({"linearize", "half-rate.yaml", "-o", "-"}, folder.path());
  const json at_half_rate = json::parse(fast.out)["margins"]["phi_command"];
  // pi / 0.026; 2.035 by the poles of the loop with scaled gains.
  CHECK(at_half_rate["gain"].get<double>() == Approx(2.035).epsilon(1e-3));
  CHECK(at_half_rate["gain_frequency"].get<double>() == Approx(120.83).epsilon(1e-4));
  CHECK(at_half_rate["gain_reduction"].is_null());

  folder.write("rest.yaml",
               about +
                   "plate: {inertia: [0.004, 0.004, 0.008]}\n"
                   "gimbal: {motor: {viscous: 0.01}}\n"
                   "controller: {state_feedback: {gain: [[5, 0, 2, 0, 2.6, 0, 0.25, 0], "
                   "[0, -5, 0, -2, 0, 2.6, 0, 0.25]]}, drives: torque, "
                   "reference: {point: [0, 0]}}\n");
  // m g = 0.1 * 9.80665 N over 5 N/m of phi's row.
  CHECK(contains(bbsim({"check", "rest.yaml"}, folder.path()).out, "or down by 0.196 at 0 rad/s"));

  folder.write("lead.yaml", about +
                                "gimbal: {servo: {natural_frequency: 130, damping: 0.717}}\n"
                                "controller: {pd: {kp: [[0.693, 0], [0, -0.693]], kv: [[0.728, 0], "
                                "[0, -0.728]]}, drives: angle, reference: {point: [0, 0]}, "
                                "sampling: {period: 0.03}}\n");
  const Result lead = bbsim({"check", "lead.yaml", "--set", "ball.radius=0.032"}, folder.path());
  CAPTURE(lead.out);
  CHECK(contains(lead.out, "stable: "));
  CHECK(contains(lead.out, " deg of lead at "));
  CHECK_FALSE(contains(lead.out, "phase -"));
  CHECK_FALSE(contains(lead.out, "not stable"));
  CHECK(contains(bbsim({"linearize", config("fig2b-literal.yaml")}).out, "the loop is not stable"));
}

TEST_CASE("margins away from home do not include spin") {
  for (const char* name : {"hold.yaml", "rig.yaml", "catch.yaml"}) {
    const Result moving = bbsim({"linearize", config(name), "--at", "1 s", "-o", "-"});
    REQUIRE(moving.exit_code == 0);
    const json all = json::parse(moving.out)["margins"];
    REQUIRE(all.size() == 2);
    for (const json& margins : all) {
      CAPTURE(name, margins.dump());
      CHECK(margins["gain_reduction"].is_null());
      CHECK(margins["gain"].is_number());
    }
  }
}

TEST_CASE("linearize and check accept servos and gains of any size") {
  for (const char* speed : {"1e5", "1e100"}) {
    for (const char* name : {"fig2b.yaml", "hold.yaml"}) {
      const std::string servo = std::string("gimbal.servo.natural_frequency=") + speed;
      CAPTURE(speed, name);
      CHECK(bbsim({"linearize", config(name), "--set", servo}).exit_code <= 1);
      CHECK(bbsim({"check", config(name), "--set", servo}).exit_code == 0);
    }
  }
  CHECK(bbsim({"linearize", config("hold.yaml"), "--set", "controller.pd.kv=[[1e6,0],[0,-100]]"})
            .exit_code == 0);
}

TEST_CASE("check does not report rounding of a stiff loss as instability") {
  const Result slow = bbsim({"check", config("hold.yaml"), "--set", "ball.losses.viscous=1e9"});
  CHECK_FALSE(contains(slow.out, "WARNING"));
  const Result sampled = bbsim({"check", config("step.yaml"), "--set", "ball.losses.viscous=1e9"});
  CHECK_FALSE(contains(sampled.out, "unstable"));
  CHECK(contains(sampled.out, "at the stability limit about home, within rounding"));
}

TEST_CASE("check reports the bandwidth of the feedback if a feedforward also moves the ball") {
  const Result led = bbsim({"check", config("rig.yaml")});
  CHECK(contains(led.out, "rad/s, of the feedback: with the reference's accelerations"));
  CHECK_FALSE(contains(led.out, "unlimited"));
  CHECK_FALSE(contains(bbsim({"check", config("fig2b.yaml")}).out, "of the feedback"));
}

TEST_CASE("linearize supports torques, losses without friction, pushes and three servos") {
  const Result regulator =
      bbsim({"linearize", config("torque-lqr.yaml"), "--plant", "--at", "0.5 s", "-o", "-"});
  CHECK(regulator.exit_code == 0);
  const json plant = json::parse(regulator.out);
  CHECK(plant["inputs"] == json::array({"phi_command", "theta_command"}));
  CHECK(plant["input_units"] == json::array({"N m", "N m"}));
  CHECK(contains(bbsim({"check", config("torque-lqr.yaml")}).out, "margins"));
  const Result legs =
      bbsim({"linearize", config("three-servos.yaml"), "--sampled", "--at", "2 s", "-o", "-"});
  CHECK(legs.exit_code == 0);
  CHECK(json::parse(legs.out)["states"][6] == "servo_third");
  const Result pushed = bbsim({"linearize", config("fig2b.yaml"), "--at", "equilibrium", "--set",
                               "ball.push={x: 0.01}", "--set", "ball.mass=0.1", "-o", "-"});
  CAPTURE(pushed.err);
  CHECK(pushed.exit_code == 0);
}

TEST_CASE("linearize refuses what it does not support, and says what it does") {
  const Result losses = bbsim({"linearize", config("slides.yaml")});
  CHECK(losses.exit_code == 2);
  CHECK(contains(losses.err, "linearize: found ball.losses.rolling, which is dry"));
  CHECK(contains(losses.err, "allowed: ball.losses.viscous alone"));
  const std::string own = BBSIM_SOURCE_DIR "/examples/controllers/python.yaml";
  const Result law = bbsim({"linearize", own, "--loop"});
  CHECK(law.exit_code == 2);
  CHECK(contains(law.err, "allowed: plant, sampled"));
  CHECK(bbsim({"linearize", own}).exit_code == 0);
  CHECK_FALSE(contains(bbsim({"check", config("sags.yaml")}).out, "margins"));
}

#ifdef BBSIM_PYTHON
// "+AAo-" is a line break in UTF-7; in the name, it could make Python read the file as UTF-7.
TEST_CASE("a scenario's name stays text in the programs that linearize writes") {
  const Folder folder;
  const std::string name = "coding: utf-7 +AAo-open('ran', 'w')+AAo- \xce\xb8 \xff.yaml";
  std::filesystem::copy_file(config("fig2b.yaml"), folder / name);
  for (const char* const program : {"plant.py", "plant.m"}) {
    CAPTURE(program);
    const Result result = bbsim({"linearize", name, "-o", program}, folder.path());
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    const std::string text = folder.read(program);
    CHECK(std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
    std::istringstream lines(text);
    std::string line;
    for (int i = 0; i < 2 && std::getline(lines, line); ++i) CHECK_FALSE(contains(line, "coding"));
    CHECK(contains(text,
                   "coding: utf-7 +AAo-open('ran', 'w')+AAo- \\xce\\xb8 \\xff.yaml about home"));
  }
  const Result run = shell(
      "mkdir empty && echo 'array = list' > empty/numpy.py && PYTHONPATH=empty python3 plant.py",
      folder.path());
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "ran"));
}
#endif

}  // namespace bbsim_test::test_linearize
