// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// First steps with your own controller: examples, templates and what check reports.
#include <filesystem>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_first_minutes {

namespace fs = std::filesystem;

namespace {

std::string source(const std::string& name) {
  return Folder().read(BBSIM_SOURCE_DIR "/" + name);
}

// A folder with the example step.
struct Step : Folder {
  Step() { expect(0, "examples step -q", *this); }

  // Runs a command with another controller.
  [[nodiscard]] Result with(const std::string& command, const std::string& key,
                            const std::string& more = "") const {
    return call(command + " step.yaml --set controller.pid=null --set '" + key + "'" + more, *this);
  }

  // Checks that the ball ends within 5 mm of the reference.
  void check_balances(const std::string& key) const {
    expect(0, with("run", key,
                   " -o /dev/null -q --expect 'end_x > 0.025' --expect 'end_x < 0.035' --expect "
                   "'max_y < 0.005'"));
    expect(0, with("check", key), {},
           {"             phi: pushes the ball towards the reference; gain ",
            "             theta: pushes the ball towards the reference; gain ", "!WARNING"});
  }
};

}  // namespace

TEST_CASE("examples are the scenarios of configs") {
  const Folder folder;
  const Result list = expect(0, call("examples"));
  CHECK(list.err.empty());
  std::size_t scenarios = 0;
  for (const auto& entry : fs::directory_iterator(BBSIM_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenarios;
    const std::string name = entry.path().stem(), text = folder.read(entry.path());
    CAPTURE(name);
    CHECK(contains('\n' + list.out, '\n' + name + ' '));
    expect(0, "examples " + name + " -q --force", folder);
    CHECK(folder.read(name + ".yaml") == text);
    CHECK(call("examples " + name + " -o - -q").out == text);
  }
  CHECK(lines(list.out).size() == scenarios);
}

TEST_CASE("an example comes with its table, whatever its destination") {
  const Folder folder;
  const std::string table = folder.read(config("recorded-angles.csv"));
  fs::create_directory(folder / "there");
  const std::string example = "examples recorded -o there/mine.yaml";
  expect(0, example, folder, {"there/mine.yaml", "recorded-angles.csv"});
  CHECK(folder.read("there/recorded-angles.csv") == table);
  expect(0, "check there/mine.yaml", folder);
  expect(0, "examples recorded -o -", folder, {"bbsim examples recorded-angles.csv"});
  CHECK(call("examples recorded-angles.csv -o -").out == table);

  // A different file under the table's name is kept; an identical one is accepted.
  expect(0, example, folder);
  folder.write("there/recorded-angles.csv", "t,phi\n0,0\n");
  expect(2, example, folder);
  CHECK(folder.read("there/recorded-angles.csv") == "t,phi\n0,0\n");
}

TEST_CASE("an unknown example is refused with the nearest name") {
  expect(2, call("examples stpe"), {"unknown example stpe; did you mean step?"});
  expect(2, call("examples zzzzzzzzzz"), {"unknown example zzzzzzzzzz; bbsim examples"});
  expect(2, call("examples -o a.yaml"));
}

TEST_CASE("without -o, examples and templates replace no existing file") {
  const Folder folder;
  const auto [line, file] = GENERATE(
      table<std::string, std::string>({{"examples step", "step.yaml"},
                                       {"new controller python", "controller.py"},
                                       {"new controller c", "controller.c"},
                                       {"new controller arduino", "controller.ino"},
                                       {"new controller arduino", "controller-wiring.yaml"},
                                       {"new rig", "my-rig.yaml"}}));
  folder.write(file, "mine\n");
  expect(2, line, folder, {file + ": already exists", "-o", "--force"});
  CHECK(folder.files() == std::vector{file});
  CHECK(folder.read(file) == "mine\n");
  expect(0, line + " --force", folder);
  CHECK(folder.read(file) != "mine\n");
}

TEST_CASE("the C template balances") {
  const Step folder;
  expect(0, "new controller c -o mine.c", folder,
         {" mine.c -o mine.so\n", "\"controller.library.file=mine.so\""});
  CHECK(folder.read("mine.c") == source("examples/templates/controller.c"));
  folder.check_balances("controller.library.file=" BBSIM_TEMPLATE_LIBRARY);
}

TEST_CASE("the sketch template balances with its wiring") {
  const Step folder;
  const std::string key =
      "controller.library={file: controller.so, wiring: controller-wiring.yaml}";
  expect(0, "new controller arduino", folder, {key});
  expect(0, "sketch controller.ino -q", folder);
  folder.check_balances(key);
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
  const Step folder;
  expect(0, "new controller python", folder, {python("controller.py")});
  folder.check_balances(python("controller.py"));
}

TEST_CASE("check reports which sign of a controller is wrong, for every kind of drive") {
  const Step folder;
  write_changed(folder, "wrong.py", "-y.command", "y.command");
  const std::string gimbal =
      GENERATE("gimbal.mounting=null", "gimbal.servo={time_constant: 0.05}",
               "gimbal.linkage={horn: 2.4 cm, arm: 6 cm, offset: [4.5 cm, 4 cm]}");
  expect(0, folder.with("check", python("wrong.py"), " --set '" + gimbal + "'"), {},
         {"\n             phi: pushes the ball towards the reference; gain ",
          "\nWARNING      theta: pushes the ball away from the reference; change the "
          "sign: positive theta drives the ball towards -y; gain "});
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
  expect(0, "check s.yaml", folder, {},
         {"\nWARNING      phi: pushes the ball away from the reference; "
          "change the sign: positive phi drives the ball towards +x; ",
          "\n             theta: pushes the ball towards the reference; "});
}

TEST_CASE("check reports swapped commands and commands that depend on nothing") {
  const Step folder;
  write_changed(folder, "exchanged.py", commands,
                "y.command(ball_y, reference_y, period), x.command(ball_x, reference_x, period)");
  write_changed(folder, "deaf.py", commands, "0.01, 0.02");
  expect(0, folder.with("check", python("exchanged.py")), {},
         {"\nWARNING      phi: depends on y, but moves the ball along x; swap "});
  expect(0, folder.with("check", python("deaf.py")), {},
         {"\nWARNING      its commands do not depend on where the ball is, within "});
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
  expect(0, "check s.yaml", folder, {},
         {"phi" + towards, "theta" + towards, "from sample 99 on", "!WARNING"});
  const std::string one = "check s.yaml --set controller.program.parameters.both=0";
  expect(0, one, folder, {}, {"phi" + towards, "theta: stays", "!WARNING"});
  expect(0, one + " --set controller.reference.point.1=0.01", folder, {},
         {"WARNING      theta: does not depend on where the ball is, within 1.568 s"});
}

TEST_CASE("check detects a wall clock, and bbsim_clock.py replaces it") {
  const Step folder;
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
  const std::string told = "the controller answers differently to the same samples, within ";
  expect(0, folder.with("check", python("wall.py")), {}, {"\nWARNING      " + told});
  expect(0, folder.with("run", python("simulated.py"),
                        " --set gimbal.mounting=null -o /dev/null -q --expect 'end_x > 0.025' "
                        "--expect 'end_x < 0.035'"));
  expect(0, folder.with("check", python("simulated.py")), {}, {"!" + told});
}

TEST_CASE("output that a controller repeats at each start of check is shown once") {
  const Step folder;
  write_changed(folder, "loud.py", ", \"reset\": True", "");  // each run then starts it
  std::string text = folder.read("loud.py");
  text.insert(text.find("for line in sys.stdin"), "print('hello', file=sys.stderr)\n");
  folder.write("loud.py", text);
  CHECK(expect(0, folder.with("check", python("loud.py"))).err == "controller: hello\n");
}
#endif

}  // namespace bbsim_test::test_first_minutes
