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

json written(const std::string& line, const Folder& folder = Folder()) {
  return json::parse(expect(0, line, folder).out);
}

}  // namespace

TEST_CASE("linearize writes A, B, C, D, names and poles as JSON") {
  const Folder folder;
  expect(0, "linearize @fig2b.yaml --plant -o plant.json", folder);
  const json plant = summary_of(folder, "plant.json");
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

  const json sampled = written("linearize @rig.yaml -o -");
  CHECK(sampled["period"] == 0.02);
  CHECK(sampled["poles"].size() == sampled["states"].size());
  CHECK(sampled["margins"]["phi_command"]["gain"].get<double>() > 1);
  CHECK(sampled["bandwidth"]["x"].is_null());  // the law uses the reference's accelerations
  CHECK(sampled["feedback_bandwidth"]["x"].is_number());
}

TEST_CASE("linearize accepts a time of the run or an equilibrium") {
  const json moving = written("linearize @fig2b.yaml --at '2 s' -o - --plant");
  CHECK(moving["at"] == "t = 2 s");
  CHECK(moving["states"].size() == 9);  // on a turning plane, spin matters
  expect(0, call("linearize @rig.yaml --at 0 -o - --sampled"));
  expect(0, call("linearize @step.yaml --at equilibrium"), {}, {"about equilibrium", "margins"});
  // The law as printed blows up before.
  expect(1, call("linearize @fig2b-literal.yaml --at 10"));
}

TEST_CASE("linearize refuses what it does not support, and says what it does") {
  const std::string own = "linearize '" BBSIM_SOURCE_DIR "/examples/controllers/python.yaml'";
  const Folder folder;
  folder.write("scene.csv", folder.read(config("fig2b.yaml")));
  for (const auto& [line, told] :
       {std::pair<std::string, std::string>{"linearize @fig2b.yaml --at '1000 s'", "1000 s"},
        {"linearize @fig2b.yaml --at somewhere", "somewhere"},
        {"linearize @fig2a.yaml --loop", "loop"},
        {"linearize @fig2b.yaml --sampled", "sampled"},
        {"linearize @fig2b.yaml --plant --loop", "plant"},
        {"linearize @fig2b.yaml -o plant.txt", "plant.txt"},
        {"linearize scene.csv -o scene.csv", "scene.csv"},
        {"linearize @slides.yaml", "linearize: found ball.losses.rolling, which is dry"},
        {own + " --loop", "allowed: plant, sampled"}}) {
    expect(2, line, folder, {told});
  }
  CHECK(folder.files().size() == 1);
  expect(0, call(own));
}

TEST_CASE("linearize's files contain what their readers expect") {
  const Folder folder;
  for (const std::string ending : {"m", "py", "csv"}) {
    expect(0, "linearize @rig.yaml -o loop." + ending, folder);
  }
  const std::vector<std::string> csv = lines(folder.read("loop.csv"));
  CHECK(csv[0].starts_with("row,x,y,vx,vy,phi,theta,phi_rate,theta_rate,"));
  CHECK(contains(csv[0], ",x_reference,y_reference"));
  CHECK(csv[1].starts_with("x_next,"));
  CHECK(contains(folder.read("loop.m"), "sys = ss(A, B, C, D, period);"));
  CHECK(contains(folder.read("loop.py"), "control.ss(A, B, C, D, period)"));
  // Python itself reads the module; a stand-in for numpy's array is used if numpy is missing.
  folder.write("read.py", R"(
import sys, types
try:
    import numpy
except ImportError:
    numpy = None
    sys.modules['numpy'] = types.SimpleNamespace(array=lambda rows: rows)
import loop
assert len(loop.A) == len(loop.states) == len(loop.B), len(loop.A)
assert len(loop.C) == len(loop.outputs) == 2
assert len(loop.D[0]) == len(loop.inputs)
assert loop.period == 0.02
if numpy:
    assert max(abs(numpy.linalg.eigvals(loop.A))) < 1
)");
  expect(0, shell("command -v python3 >/dev/null || exit 0\npython3 read.py", folder));
  expect(0,
         shell("command -v octave-cli >/dev/null || exit 0\n"
               "octave-cli --norc --eval 'loop; assert(max(abs(eig(A))) < 1); assert(size(B, 2) == "
               "numel(inputs))'\n",
               folder));
}

TEST_CASE("no zero that linearize writes or prints has a sign") {
  const Folder folder;
  const std::string line = "linearize @" + std::string(GENERATE("three-servos", "torque-lqr")) +
                           ".yaml --" + GENERATE("plant", "loop");
  for (const std::string ending : {"m", "py", "csv", "json"}) {
    expect(0, line + " -o all." + ending, folder);
  }
  folder.write("printed", expect(0, line, folder).out);
  const Result found = shell(
      "grep -nE '(^|[^0-9e])-0(\\.0)?([^0-9.]|$)' all.* ; "
      "grep -nE '(^| )-0([^0-9.]|$)' printed",
      folder);
  CAPTURE(line);
  CHECK(found.out.empty());
}

TEST_CASE("check prints the margins of a stable loop, and the bandwidth of the feedback") {
  for (const auto& [scene, said] :
       {std::pair<std::string, std::vector<std::string>>{
            "fig2b", {"margins", "phase ", "bandwidth", "!of the feedback"}},
        // A feedforward also moves the ball.
        {"rig", {"rad/s, of the feedback: with the reference's accelerations", "!unlimited"}},
        {"torque-lqr", {"margins"}},
        {"sags", {"!margins"}},
        {"fig2b-literal", {"!margins"}},
        {"fig2a", {"!margins"}}}) {
    expect(0, call("check @" + scene + ".yaml"), {}, said);
  }
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
  const json at_half_rate =
      written("linearize half-rate.yaml -o -", folder)["margins"]["phi_command"];
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
  CHECK(contains(call("check rest.yaml", folder).out, "or down by 0.196 at 0 rad/s"));

  folder.write("lead.yaml", about +
                                "gimbal: {servo: {natural_frequency: 130, damping: 0.717}}\n"
                                "controller: {pd: {kp: [[0.693, 0], [0, -0.693]], kv: [[0.728, 0], "
                                "[0, -0.728]]}, drives: angle, reference: {point: [0, 0]}, "
                                "sampling: {period: 0.03}}\n");
  expect(0, "check lead.yaml --set ball.radius=0.032", folder, {},
         {"stable: ", " deg of lead at ", "!phase -", "!not stable"});
  CHECK(contains(call("linearize @fig2b-literal.yaml").out, "the loop is not stable"));
}

TEST_CASE("margins away from home do not include spin") {
  const std::string name = GENERATE("hold", "rig", "catch");
  const json all = written("linearize @" + name + ".yaml --at '1 s' -o -")["margins"];
  REQUIRE(all.size() == 2);
  for (const json& margins : all) {
    CAPTURE(name, margins.dump());
    CHECK(margins["gain_reduction"].is_null());
    CHECK(margins["gain"].is_number());
  }
}

TEST_CASE("linearize and check accept servos and gains of any size") {
  const std::string scene =
      std::string(" @") + GENERATE("fig2b", "hold") +
      ".yaml --set gimbal.servo.natural_frequency=" + GENERATE("1e5", "1e100");
  CHECK(call("linearize" + scene).exit_code <= 1);
  expect(0, call("check" + scene));
  expect(0, call("linearize @hold.yaml --set controller.pd.kv=[[1e6,0],[0,-100]]"));
}

TEST_CASE("check does not report rounding of a stiff loss as instability") {
  expect(0, call("check @hold.yaml --set ball.losses.viscous=1e9"), {}, {"!WARNING"});
  expect(0, call("check @step.yaml --set ball.losses.viscous=1e9"), {},
         {"!unstable", "at the stability limit about home, within rounding"});
}

TEST_CASE("linearize supports torques, losses without friction, pushes and three servos") {
  const json plant = written("linearize @torque-lqr.yaml --plant --at '0.5 s' -o -");
  CHECK(plant["inputs"] == json::array({"phi_command", "theta_command"}));
  CHECK(plant["input_units"] == json::array({"N m", "N m"}));
  CHECK(written("linearize @three-servos.yaml --sampled --at '2 s' -o -")["states"][6] ==
        "servo_third");
  expect(0, call("linearize @fig2b.yaml --at equilibrium --set 'ball.push={x: 0.01}' --set "
                 "ball.mass=0.1 -o -"));
}

#ifdef BBSIM_PYTHON
// "+AAo-" is a line break in UTF-7; in the name, it could make Python read the file as UTF-7.
TEST_CASE("a scenario's name stays text in the programs that linearize writes") {
  const Folder folder;
  const std::string name = "coding: utf-7 +AAo-open('ran', 'w')+AAo- \xce\xb8 \xff.yaml";
  std::filesystem::copy_file(config("fig2b.yaml"), folder / name);
  for (const std::string program : {"plant.py", "plant.m"}) {
    expect(0, bbsim({"linearize", name, "-o", program}, folder.path()));
    const std::string text = folder.read(program);
    CHECK(std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
    for (const std::size_t line : {0U, 1U}) CHECK_FALSE(contains(lines(text).at(line), "coding"));
    CHECK(contains(text,
                   "coding: utf-7 +AAo-open('ran', 'w')+AAo- \\xce\\xb8 \\xff.yaml about home"));
  }
  const Result run = expect(0, shell("mkdir empty && echo 'array = list' > empty/numpy.py && "
                                     "PYTHONPATH=empty python3 plant.py",
                                     folder));
  CHECK(run.err.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "ran"));
}
#endif

}  // namespace bbsim_test::test_linearize
