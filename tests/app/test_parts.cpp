// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run split in two gives the same bytes as one run.
#include <filesystem>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

using namespace bbsim_test;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Result run(const Folder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "run");
  Result result = bbsim(std::move(arguments), folder.path());
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  return result;
}

std::string example(const std::string& name) {
  return BBSIM_SOURCE_DIR "/examples/controllers/" + name;
}

#ifdef BBSIM_PYTHON
constexpr bool has_python = true;
#else
constexpr bool has_python = false;
#endif

const std::string square = "controller.reference={square: {amplitude: [3 cm, 2 cm], period: 2.3}}";

// The rows without their header.
std::string rows_of(const std::string& csv) {
  return csv.substr(csv.find('\n') + 1);
}

}  // namespace

TEST_CASE("the rows of two parts equal those of one run bit for bit") {
  struct Scene {
    const char* name;
    const char* until;
    std::vector<std::string> more{};
  };
  // Smooth scenes of few and of many steps; table stops and reference jumps; a rig with noise and
  // delays, split at a sample and between samples; limits that switch; noted events.
  const Scene scene = GENERATE(
      Scene{"fig2a", "5"}, Scene{"fig2b", "7.05"}, Scene{"recorded", "2"},
      Scene{"rig", "10.01", {"--set", "time.step=\"10 ms\""}}, Scene{"rig", "20 s"},
      Scene{"step", "600 ms"}, Scene{"catch", "1"},
      Scene{"fig2b", "7.1", {"--set", "controller.reference={step: {to: [5 cm, 0], at: 7.1}}"}},
      Scene{"fig2b", "7", {"--set", square}}, Scene{"rig", "7", {"--set", square}},
      Scene{"fig2a", "9.99", {"--set", "output.columns=[t, gamma, spin, torque_phi]"}});
  CAPTURE(scene.name, scene.until);
  const Folder folder;
  const auto with = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), config(std::string(scene.name) + ".yaml"));
    arguments.insert(arguments.end(), scene.more.begin(), scene.more.end());
    return arguments;
  };
  run(folder, with({"-o", "whole.csv"}));
  const Result first = run(
      folder, with({"-o", "first.csv", "--save-state", "middle.state", "--until", scene.until}));
  CHECK(contains(first.err, "middle.state: the state at t = "));
  run(folder, with({"-o", "second.csv", "--from-state", "middle.state"}));
  const std::string a = folder.read("first.csv"), b = rows_of(folder.read("second.csv"));
  CHECK(b.size() > 20);
  CHECK(a + b == folder.read("whole.csv"));
}

TEST_CASE("parts with your own controller, library or program, equal one run too") {
  struct Part {
    const char *until, *step;
  };
  // At a sample, between samples, and as a command arrives.
  const Part part =
      GENERATE(Part{"600 ms", "20 ms"}, Part{"604 ms", "4 ms"}, Part{"1.21", "10 ms"});
  const bool program = GENERATE(false, true);
  if (program && !has_python) return;
  std::vector<std::string> rig{example(program ? "python.yaml" : "library.yaml")};
  if (!program) {
    rig.insert(rig.end(), {"--set", "controller.library.file=\"" BBSIM_EXAMPLE_LIBRARY "\""});
  }
  CAPTURE(rig[0], part.until);
  for (const char* set :
       {"controller.sensor.noise=\"0.5 mm\"", "controller.sensor.dropout=0.2", "time.end=4"}) {
    rig.insert(rig.end(), {"--set", set});
  }
  rig.insert(rig.end(), {"--set", std::string("time.step=\"") + part.step + '"'});
  const Folder folder;
  const auto with = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), rig.begin(), rig.end());
    return arguments;
  };
  run(folder, with({"-o", "whole.csv"}));
  run(folder, with({"-o", "first.csv", "--save-state", "middle.state", "--until", part.until}));
  run(folder, with({"-o", "second.csv", "--from-state", "middle.state"}));
  const std::string a = folder.read("first.csv"), b = rows_of(folder.read("second.csv"));
  CHECK(b.size() > 20);
  CHECK(a + b == folder.read("whole.csv"));
}

TEST_CASE("a state belongs to the controller that made it and to its settings") {
  const Folder folder;
  if (!has_python) return;
  for (const char* name : {"pid.py", "python.yaml"}) {
    std::filesystem::copy(example(name), folder.path() / name);
  }
  run(folder, {"python.yaml", "-o", "a.csv", "--save-state", "a.state", "--until", "1"});
  const auto refusal = [&](const char* columns) {
    const Result result = bbsim({"run", "python.yaml", "-o", "b.csv", "--from-state", "a.state",
                                 "--set", std::string("output.columns=") + columns},
                                folder.path());
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(contains(refusal("[t, x_integral, y_integral]"), "another scenario"));
  folder.write("pid.py", "# changed\n" + folder.read("pid.py"));
  CHECK(contains(refusal("[t, x, x_integral]"), "files of a controller"));
}

TEST_CASE("a run may continue beyond its planned end") {
  const Folder folder;
  const std::string rig = config("rig.yaml");
  run(folder, {rig, "-o", "whole.csv", "--set", "time.end=9"});
  run(folder, {rig, "-o", "a.csv", "--set", "time.end=3", "--save-state", "a.state"});
  run(folder, {rig, "-o", "b.csv", "--set", "time.end=6", "--from-state", "a.state", "--save-state",
               "b.state"});
  run(folder, {rig, "-o", "c.csv", "--set", "time.end=9", "--from-state", "b.state"});
  CHECK(folder.read("a.csv") + rows_of(folder.read("b.csv")) + rows_of(folder.read("c.csv")) ==
        folder.read("whole.csv"));

  // Fig. 2(a) takes four steps in all, the last one fitted to the end.
  const std::string smooth = config("fig2a.yaml");
  run(folder, {smooth, "-o", "d.csv", "--set", "time.end=5", "--save-state", "d.state"});
  const Result refused =
      bbsim({"run", smooth, "-o", "e.csv", "--from-state", "d.state"}, folder.path());
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "--until"));
  run(folder, {smooth, "-o", "e.csv", "--from-state", "d.state", "--set", "time.end=100"});
  run(folder, {smooth, "-o", "f.csv", "--set", "time.end=100"});
  CHECK(folder.read("d.csv") + rows_of(folder.read("e.csv")) == folder.read("f.csv"));
}

TEST_CASE("a state is refused if the bytes could not equal those of one run") {
  const Folder folder;
  const std::string rig = config("rig.yaml");
  run(folder, {rig, "-o", "a.csv", "--save-state", "a.state", "--until", "1"});
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"run", "-o", "b.csv"});
    const Result result = bbsim(std::move(arguments), folder.path());
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(contains(refusal({config("step.yaml"), "--from-state", "a.state"}), "another scenario"));
  CHECK(contains(refusal({rig, "--from-state", "a.state", "--set", "ball.mass=1"}),
                 "another scenario"));
  CHECK(contains(refusal({rig, "--from-state", "a.state", "--set", "time.end=50"}), "time.end"));
  CHECK(contains(refusal({rig, "--from-state", "a.csv"}), "no state of a run"));
  CHECK(contains(refusal({rig, "--from-state", "none.state"}), "cannot read"));
  CHECK(contains(refusal({rig, "--save-state", "c.state", "--set", "solver.method=bdf"}), "radau"));
  CHECK(contains(refusal({rig, "--save-state", "c.state", "--error", "1 um"}), "solver.error"));
  CHECK(contains(refusal({config("slides.yaml"), "--save-state", "c.state"}), "sliding"));
  CHECK(contains(refusal({example("python.yaml"), "--save-state", "c.state", "--set",
                          std::string("controller.program.command=[\"") + BBSIM_TEST_CHILD + "\"]",
                          "--set", "controller.program.parameters={}"}),
                 "cannot save its state"));
  CHECK(contains(refusal({rig, "--until", "3"}), "--save-state"));
  CHECK(contains(refusal({rig, "--save-state", "c.state", "--until", "50"}), "--until"));
  CHECK(refusal({rig, "--from-state", "a.state", "--save-state", "a.state", "--until", "3"}) != "");
  CHECK(
      contains(refusal({rig, "--from-state", "a.state", "--save-state", "c.state", "--until", "1"}),
               "an end after that"));
  CHECK(contains(refusal({rig, "--from-state", "a.state", "--set", "output.columns=[t, ball_qw]"}),
                 "gamma"));
  std::string damaged = folder.read("a.state");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  folder.write("damaged.state", damaged);
  CHECK(contains(refusal({rig, "--from-state", "damaged.state"}), "damaged"));
  folder.write("short.state", folder.read("a.state").substr(0, 1000));
  CHECK(contains(refusal({rig, "--from-state", "short.state"}), "damaged"));
  CHECK(folder.files() ==
        std::vector<std::string>{"a.csv", "a.state", "damaged.state", "short.state"});
}

TEST_CASE("events are reported by the part in which they occur") {
  // After the ball falls off, nothing remains to continue from.
  const Folder folder;
  const Result falls =
      bbsim({"run", config("falls.yaml"), "-o", "a.csv", "--save-state", "a.state"}, folder.path());
  CHECK(falls.exit_code == 1);
  CHECK(contains(falls.err, "a.state: not written"));
  CHECK(folder.files() == std::vector<std::string>{"a.csv"});
  // A state saved before the fall can continue.
  run(folder, {config("falls.yaml"), "-o", "b.csv", "--save-state", "b.state", "--until", "0.5"});
  const Result rest =
      bbsim({"run", config("falls.yaml"), "-o", "c.csv", "--from-state", "b.state"}, folder.path());
  CHECK(rest.exit_code == 1);
  CHECK(contains(rest.err, "left the plate"));
  CHECK(folder.read("b.csv") + rows_of(folder.read("c.csv")) == folder.read("a.csv"));
}

TEST_CASE("a switch at a part's last row belongs to that part") {
  const Folder folder;
  // A command that lifts the ball off as it arrives, at 0.02 s.
  const std::vector<std::string> lifts{config("catch.yaml"), "--set",
                                       "gimbal.servo.acceleration_limit=60"};
  const auto part = [&](std::vector<std::string> more) {
    more.insert(more.begin(), lifts.begin(), lifts.end());
    more.insert(more.begin(), "run");
    return bbsim(more, folder.path());
  };
  const Result stopped = part({"-o", "a.csv", "--until", "0.02", "--save-state", "a.state"});
  CHECK(stopped.exit_code == 1);
  CHECK(contains(stopped.err, "the run stopped at t = 0.02 s"));
  CHECK(contains(stopped.err, "a.state: not written"));
  // A noted event is reported once.
  const std::vector<std::string> noted{"--set", "events.lift_off=note", "--set", "time.end=0.05"};
  std::vector<std::string> first{"-o", "b.csv", "--until", "0.02", "--save-state", "b.state"};
  std::vector<std::string> second{"-o", "c.csv", "--from-state", "b.state"};
  for (auto* const words : {&first, &second}) {
    words->insert(words->end(), noted.begin(), noted.end());
  }
  CHECK(contains(part(first).err, "noted: lift_off, once at t = 0.02 s"));
  const Result rest = part(second);
  CHECK(rest.exit_code == 0);
  CHECK_FALSE(contains(rest.err, "noted: lift_off"));
}
