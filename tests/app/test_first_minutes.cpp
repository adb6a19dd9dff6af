// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// First steps with your own controller: examples, templates and what check reports.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_first_minutes {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

std::string source(const std::string& name) {
  std::ifstream file(std::string(BBSIM_SOURCE_DIR) + "/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Writes the example step into a folder.
void write_step(const Folder& folder) {
  REQUIRE(bbsim({"examples", "step", "-q"}, folder.path()).exit_code == 0);
}

std::vector<std::string> on_step(const std::string& command, const std::string& key) {
  return {command, "step.yaml", "--set", "controller.pid=null", "--set", key};
}

// Checks that the ball ends within 5 mm of the reference.
void check_balances(const Folder& folder, const std::string& key) {
  std::vector<std::string> words = on_step("run", key);
  words.insert(words.end(), {"-o", "/dev/null", "-q", "--expect", "end_x > 0.025", "--expect",
                             "end_x < 0.035", "--expect", "max_y < 0.005"});
  const Result run = bbsim(words, folder.path());
  CAPTURE(key, run.err);
  CHECK(run.exit_code == 0);

  const Result check = bbsim(on_step("check", key), folder.path());
  CAPTURE(check.out, check.err);
  CHECK(check.exit_code == 0);
  for (const char* angle : {"phi", "theta"}) {
    CHECK_THAT(check.out, Contains(std::string("             ") + angle +
                                   ": pushes the ball towards the reference; gain "));
  }
  CHECK_THAT(check.out, !Contains("WARNING"));
}

}  // namespace

TEST_CASE("examples are the scenarios of configs") {
  const Folder folder;
  const Result list = bbsim({"examples"});
  REQUIRE(list.exit_code == 0);
  CHECK(list.err.empty());
  std::size_t scenarios = 0;
  for (const auto& entry : fs::directory_iterator(std::string(BBSIM_SOURCE_DIR) + "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenarios;
    const std::string name = entry.path().stem();
    CAPTURE(name);
    CHECK_THAT('\n' + list.out, Contains('\n' + name + ' '));
    REQUIRE(bbsim({"examples", name, "-q", "--force"}, folder.path()).exit_code == 0);
    CHECK(folder.read(name + ".yaml") == source("configs/" + name + ".yaml"));
    CHECK(bbsim({"examples", name, "-o", "-", "-q"}).out == source("configs/" + name + ".yaml"));
  }
  CHECK(std::count(list.out.begin(), list.out.end(), '\n') ==
        static_cast<std::ptrdiff_t>(scenarios));
  CHECK_THAT(list.out,
             Contains("\nfig2b            Fig. 2(b) of the paper: a PD controller leads "));
}

TEST_CASE("an example comes with its table, whatever its destination") {
  const Folder folder;
  fs::create_directory(folder / "there");
  const Result copied = bbsim({"examples", "recorded", "-o", "there/mine.yaml"}, folder.path());
  CHECK(copied.exit_code == 0);
  CHECK(copied.err == "there/mine.yaml: written, with its table recorded-angles.csv\n");
  CHECK(folder.read("there/recorded-angles.csv") == source("configs/recorded-angles.csv"));
  CHECK(bbsim({"check", "there/mine.yaml"}, folder.path()).exit_code == 0);

  CHECK(bbsim({"examples", "recorded", "-o", "-"}).err ==
        "it reads recorded-angles.csv: bbsim examples recorded-angles.csv\n");
  CHECK(bbsim({"examples", "recorded-angles.csv", "-o", "-"}).out ==
        source("configs/recorded-angles.csv"));

  // A different file under the table's name is kept; an identical one is accepted.
  CHECK(bbsim({"examples", "recorded", "-o", "there/mine.yaml"}, folder.path()).exit_code == 0);
  folder.write("there/recorded-angles.csv", "t,phi\n0,0\n");
  const Result kept = bbsim({"examples", "recorded", "-o", "there/mine.yaml"}, folder.path());
  CHECK(kept.exit_code == 2);
  CHECK(folder.read("there/recorded-angles.csv") == "t,phi\n0,0\n");
}

TEST_CASE("an unknown example is refused with the nearest name") {
  const Result near = bbsim({"examples", "stpe"});
  CHECK(near.exit_code == 2);
  CHECK(near.err == "unknown example stpe; did you mean step?\n");
  CHECK(bbsim({"examples", "zzzzzzzzzz"}).err ==
        "unknown example zzzzzzzzzz; bbsim examples lists them\n");
  CHECK(bbsim({"examples", "-o", "a.yaml"}).exit_code == 2);
}

TEST_CASE("without -o, examples and templates replace no existing file") {
  const Folder folder;
  using Words = std::vector<std::string>;
  const auto [words, file] = GENERATE(
      table<Words, std::string>({{Words{"examples", "step"}, "step.yaml"},
                                 {Words{"new", "controller", "python"}, "controller.py"},
                                 {Words{"new", "controller", "c"}, "controller.c"},
                                 {Words{"new", "controller", "arduino"}, "controller.ino"},
                                 {Words{"new", "controller", "arduino"}, "controller-wiring.yaml"},
                                 {Words{"new", "rig"}, "my-rig.yaml"}}));
  folder.write(file, "mine\n");
  const Result kept = bbsim(words, folder.path());
  CAPTURE(file);
  CHECK(kept.exit_code == 2);
  CHECK(kept.err == file +
                        ": already exists; allowed: to write a new file. Name another file with "
                        "-o, or replace this one with --force\n");
  CHECK(folder.files() == std::vector{file});
  CHECK(folder.read(file) == "mine\n");
  Words forced = words;
  forced.emplace_back("--force");
  CHECK(bbsim(forced, folder.path()).exit_code == 0);
  CHECK(folder.read(file) != "mine\n");
}

TEST_CASE("the C template balances") {
  const Folder folder;
  write_step(folder);
  const Result made = bbsim({"new", "controller", "c", "-o", "mine.c"}, folder.path());
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.err, Contains(" mine.c -o mine.so\n  bbsim examples step\n  bbsim run step.yaml "
                                "--set controller.pid=null --set "
                                "\"controller.library.file=mine.so\"\n"));
  CHECK(folder.read("mine.c") == source("examples/templates/controller.c"));
  check_balances(folder, std::string("controller.library.file=") + BBSIM_TEMPLATE_LIBRARY);
}

TEST_CASE("the sketch template balances with its wiring") {
  const Folder folder;
  write_step(folder);
  const Result made = bbsim({"new", "controller", "arduino"}, folder.path());
  REQUIRE(made.exit_code == 0);
  const std::string key =
      "controller.library={file: controller.so, wiring: controller-wiring.yaml}";
  CHECK_THAT(made.err, Contains(key));
  REQUIRE(bbsim({"sketch", "controller.ino", "-q"}, folder.path()).exit_code == 0);
  check_balances(folder, key);
}

#ifdef BBSIM_PYTHON
namespace {

std::string python(const std::string& file) {
  return "controller.program.command=[python3, " + file + "]";
}

// Writes the Python template with one part replaced.
void write_changed(const Folder& folder, const std::string& file, const std::string& part,
                   const std::string& by) {
  std::string text = source("examples/templates/controller.py");
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  folder.write(file, text.replace(at, part.size(), by));
}

const char* const commands =
    "x.command(ball_x, reference_x, period), -y.command(ball_y, reference_y, period)";

}  // namespace

TEST_CASE("the Python template balances") {
  const Folder folder;
  write_step(folder);
  const Result made = bbsim({"new", "controller", "python"}, folder.path());
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.err, Contains(python("controller.py")));
  check_balances(folder, python("controller.py"));
}

TEST_CASE("check reports which sign of a controller is wrong, for every kind of drive") {
  const Folder folder;
  write_step(folder);
  write_changed(folder, "wrong.py", "-y.command", "y.command");
  const std::string gimbal =
      GENERATE("gimbal.mounting=null", "gimbal.servo={time_constant: 0.05}",
               "gimbal.linkage={horn: \"2.4 cm\", arm: \"6 cm\", offset: [\"4.5 cm\", \"4 cm\"]}");
  std::vector<std::string> words = on_step("check", python("wrong.py"));
  words.insert(words.end(), {"--set", gimbal});
  const Result check = bbsim(words, folder.path());
  CAPTURE(gimbal, check.err);
  CHECK(check.exit_code == 0);
  CHECK_THAT(check.out,
             Contains("\n             phi: pushes the ball towards the reference; gain "));
  CHECK_THAT(check.out,
             Contains("\nWARNING      theta: pushes the ball away from the reference; change the "
                      "sign: positive theta drives the ball towards -y; gain "));
}

TEST_CASE("check reports the same of accelerations and torques as of angles") {
  const Folder folder;
  write_changed(folder, "wrong.py", "x.command(ball_x, reference_x, period), -y",
                "-x.command(ball_x, reference_x, period), -y");
  const std::string plate = "plate: {size: [0.3, 0.3], inertia: [0.01, 0.01, 0.02]}\n";
  const std::string drives = GENERATE("acceleration", "torque");
  folder.write("s.yaml", "ball: {radius: 0.02, mass: 0.03}\n" + (drives == "torque" ? plate : "") +
                             "controller:\n  program: {command: [python3, wrong.py]}\n"
                             "  drives: " +
                             drives +
                             "\n  reference: {point: [0, 0]}\n  sampling: {period: 0.02}\n"
                             "time: {end: 1, step: 0.1}\n");
  const Result check = bbsim({"check", "s.yaml"}, folder.path());
  CAPTURE(drives, check.err);
  CHECK(check.exit_code == 0);
  CHECK_THAT(check.out, Contains("\nWARNING      phi: pushes the ball away from the reference; "
                                 "change the sign: positive phi drives the ball towards +x; "));
  CHECK_THAT(check.out, Contains("\n             theta: pushes the ball towards the reference; "));
}

TEST_CASE("check reports swapped commands and commands that depend on nothing") {
  const Folder folder;
  write_step(folder);
  write_changed(folder, "exchanged.py", commands,
                "y.command(ball_y, reference_y, period), x.command(ball_x, reference_x, period)");
  write_changed(folder, "deaf.py", commands, "0.01, 0.02");
  const Result exchanged = bbsim(on_step("check", python("exchanged.py")), folder.path());
  CHECK_THAT(exchanged.out, Contains("\nWARNING      phi: depends on y, but moves the ball along "
                                     "x; swap the commands, or the coordinates\n"));
  const Result deaf = bbsim(on_step("check", python("deaf.py")), folder.path());
  CHECK_THAT(deaf.out, Contains("\nWARNING      its commands do not depend on where the ball is, "
                                "within "));
}

TEST_CASE("check waits for a controller that answers late, and accepts one that drives one axis") {
  const Folder folder;
  // Samples of 2 ms; new commands for phi and theta every 40 and 100 of them.
  folder.write("late.py",
               "import json, sys\n"
               "for line in sys.stdin:\n"
               "    m = json.loads(line)\n"
               "    if 'protocol' in m:\n"
               "        u, both, answer = [0, 0], m['parameters']['both'], "
               "{'protocol': 1, 'reset': True}\n"
               "    else:\n"
               "        if m['sample'] % 40 == 39: u[0] = -0.7 * m['ball'][0]\n"
               "        if m['sample'] % 100 == 99: u[1] = 0.7 * both * m['ball'][1]\n"
               "        answer = {'command': u}\n"
               "    print(json.dumps(answer), flush=True)\n");
  folder.write("s.yaml",
               "ball: {radius: 0.01, position: [0.04, 0]}\n"
               "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
               "controller:\n"
               "  program: {command: [python3, late.py], parameters: {both: 1}}\n"
               "  drives: angle\n  reference: {point: [0, 0]}\n  sampling: {period: 0.002}\n"
               "time: {end: 1, step: 0.1}\n");
  const std::string towards = ": pushes the ball towards the reference";
  const std::string both = bbsim({"check", "s.yaml"}, folder.path()).out;
  CHECK_THAT(both, Contains("phi" + towards) && Contains("theta" + towards) &&
                       Contains("from sample 99 on") && !Contains("WARNING"));
  const std::vector<std::string> one{"check", "s.yaml", "--set",
                                     "controller.program.parameters.both=0"};
  CHECK_THAT(bbsim(one, folder.path()).out,
             Contains("phi" + towards) && Contains("theta: stays") && !Contains("WARNING"));
  std::vector<std::string> led = one;
  led.insert(led.end(), {"--set", "controller.reference.point.1=0.01"});
  CHECK_THAT(bbsim(led, folder.path()).out,
             Contains("WARNING      theta: does not depend on where the ball is, within 1.568 s"));
}

TEST_CASE("check detects a wall clock, and bbsim_clock.py replaces it") {
  const Folder folder;
  write_step(folder);
  folder.write("bbsim_clock.py", source("examples/controllers/bbsim_clock.py"));
  const std::string reads =
      "import json, sys, time\n"
      "for line in sys.stdin:\n"
      "    m = json.loads(line)\n"
      "    if 'protocol' in m:\n"
      "        last, answer = None, {'protocol': 1, 'reset': True}\n"
      "    else:\n"
      "        CLOCK = m['t']\n"
      "        now, at = time.monotonic(), m['ball']\n"
      "        v = [(a - b) / (now - last[0]) for a, b in zip(at, last[1])] if last else [0, 0]\n"
      "        last = now, at\n"
      "        u = [0.7 * (d - p) - 0.6 * w for d, p, w in zip(m['reference'], at, v)]\n"
      "        answer = {'command': [u[0], -u[1]]}\n"
      "        time.sleep(0.001)\n"
      "    print(json.dumps(answer), flush=True)\n";
  folder.write("wall.py", reads);
  std::string simulated = "import bbsim_clock\n" + reads;
  simulated.replace(simulated.find("CLOCK"), 5, "bbsim_clock.now");
  folder.write("simulated.py", simulated);
  const char* const told =
      "\nWARNING      the controller answers differently to the same samples, within ";
  CHECK_THAT(bbsim(on_step("check", python("wall.py")), folder.path()).out, Contains(told));
  std::vector<std::string> words = on_step("run", python("simulated.py"));
  words.insert(words.end(), {"--set", "gimbal.mounting=null", "-o", "/dev/null", "-q", "--expect",
                             "end_x > 0.025", "--expect", "end_x < 0.035"});
  CHECK(bbsim(words, folder.path()).exit_code == 0);
  CHECK_THAT(bbsim(on_step("check", python("simulated.py")), folder.path()).out, !Contains(told));
}

TEST_CASE("output that a controller repeats at each start of check is shown once") {
  const Folder folder;
  write_step(folder);
  write_changed(folder, "loud.py", ", \"reset\": True",
                "");  // each run then starts it
  std::string text = folder.read("loud.py");
  text.insert(text.find("for line in sys.stdin"), "print('hello', file=sys.stderr)\n");
  folder.write("loud.py", text);
  const Result check = bbsim(on_step("check", python("loud.py")), folder.path());
  CHECK(check.exit_code == 0);
  CHECK(check.err == "controller: hello\n");
}
#endif

}  // namespace bbsim_test::test_first_minutes
