// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The controllers of examples/controllers against the built-in law, and library controllers.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_own_controller {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string example(const std::string& name) {
  return std::string(BBSIM_SOURCE_DIR) + "/examples/controllers/" + name;
}

constexpr const char* all_columns =
    "output.columns=[t, x, y, vx, vy, spin, phi, theta, phi_rate, theta_rate, phi_command, "
    "theta_command, x_measured, y_measured]";

std::string csv_of(std::vector<std::string> words) {
  words.insert(words.begin(), "run");
  words.insert(words.end(), {"--set", all_columns, "-o", "-"});
  const Result result = bbsim(words);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return result.out;
}

const std::string library = std::string("controller.library.file=") + BBSIM_EXAMPLE_LIBRARY;

// The margins that bbsim prints for `words`, of each command in turn.
std::vector<double> margins_of(const std::vector<std::string>& words) {
  const Result result = bbsim(words);
  CAPTURE(result.out, result.err);
  REQUIRE(result.exit_code == 0);
  std::vector<double> numbers;
  for (const char* angle : {"\n  phi        gain by ", "\n  theta      gain by "}) {
    const std::size_t line = result.out.find(angle);
    REQUIRE(line != std::string::npos);
    for (const char* before : {"gain by ", "down by ", "phase ", "delay "}) {
      const std::size_t at = result.out.find(before, line);
      REQUIRE(at < result.out.find('\n', line + 1));
      numbers.push_back(std::stod(result.out.substr(at + std::string(before).size())));
    }
  }
  return numbers;
}

void check_margins(const std::vector<std::string>& own, const std::vector<std::string>& built_in) {
  const std::vector<double> estimated = margins_of(own), exact = margins_of(built_in);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    CAPTURE(i, estimated[i], exact[i]);
    CHECK(std::abs(estimated[i] - exact[i]) < 0.02 * exact[i]);
  }
}

std::vector<std::string> with_misdeeds(const std::string& mode, const std::string& file = "") {
  return {"run",   example("library.yaml"),
          "--set", "controller.library.file=" + (file.empty() ? BBSIM_MISDEEDS : file),
          "--set", "controller.library.parameters={mode: " + mode + "}",
          "--set", "output.columns=[t, x, samples]",
          "--set", "time.end=0.2",
          "-o",    "-",
          "-q"};
}

}  // namespace

TEST_CASE("the example library reproduces the built-in PID's trajectory bit for bit") {
  CHECK(csv_of({example("library.yaml"), "--set", library}) == csv_of({config("step.yaml")}));
}

TEST_CASE("derivatives under your own controller are those of the built-in law") {
  const Folder folder;
  const auto gradient = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    words.insert(words.end(),
                 {"--set", "controller.sensor.resolution=0", "--set", "time.end=2", "--sensitivity",
                  "gravity", "--measure", "end_x", "--summary", "s.json", "-o", "rows.csv"});
    const Result result = bbsim(words, folder.path());
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(folder.read("s.json"))["gradients"]["end_x"]["gravity"]
        .get<double>();
  };
  const double wanted = gradient({config("step.yaml")});
  CHECK(gradient({example("library.yaml"), "--set", library}) == Approx(wanted).epsilon(1e-6));
#ifdef BBSIM_PYTHON
  CHECK(gradient({example("python.yaml")}) == Approx(wanted).epsilon(1e-6));
#endif
}

TEST_CASE("the sketch reproduces it too, with stepped servos") {
  const Folder folder;
  REQUIRE(bbsim({"sketch", example("arduino/pid.ino"), "-o", folder / "pid.so"}).exit_code == 0);
  CHECK(csv_of(
            {example("arduino.yaml"), "--set", "controller.library.file=" + (folder / "pid.so")}) ==
        csv_of({config("step.yaml"), "--set", "controller.sampling.resolution=\"0.1 deg\""}));
}

#ifdef BBSIM_PYTHON
TEST_CASE("the Python program reproduces it too, also with noise and dropouts") {
  CHECK(csv_of({example("python.yaml")}) == csv_of({config("step.yaml")}));
  const std::vector<std::string> worse = {"--set", "controller.sensor.noise=\"0.5 mm\"",
                                          "--set", "controller.sensor.dropout=0.2",
                                          "--set", "ball.position=[-0.1, 0.03]"};
  std::vector<std::string> own{example("python.yaml")}, built_in{config("step.yaml")},
      in_c{example("library.yaml"), "--set", library};
  for (std::vector<std::string>* words : {&own, &built_in, &in_c}) {
    words->insert(words->end(), worse.begin(), worse.end());
  }
  const std::string wanted = csv_of(built_in);
  CHECK(csv_of(own) == wanted);
  CHECK(csv_of(in_c) == wanted);
}

TEST_CASE("parameters of a program are keys that can be set and swept") {
  const Result sweep = bbsim({"sweep", example("python.yaml"), "--vary",
                              "controller.program.parameters.ki=list:0.2,0.35", "--measure",
                              "end_x,max_x_integral", "-o", "-", "-q"});
  CAPTURE(sweep.err);
  REQUIRE(sweep.exit_code == 0);
  const Result built_in =
      bbsim({"sweep", config("step.yaml"), "--vary", "controller.pid.ki.0.0=list:0.2,0.35",
             "--measure", "end_x", "-o", "-", "-q"});
  const auto end_x = [](const std::string& rows, std::size_t row) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < row; ++i) at = rows.find('\n', at) + 1;
    for (int i = 0; i < 5; ++i) at = rows.find(',', at) + 1;
    return rows.substr(at, rows.find_first_of(",\n", at) - at);
  };
  // Only theta's ki differs, and the ball stays on the x axis.
  CHECK(end_x(sweep.out, 1) == end_x(built_in.out, 1));
  CHECK(end_x(sweep.out, 2) == end_x(built_in.out, 2));
  CHECK(end_x(sweep.out, 1) != end_x(sweep.out, 2));
}
#endif

TEST_CASE("check estimates the built-in PID's margins for the same external law") {
  const std::vector<std::string> built_in{"linearize", config("step.yaml")};
  check_margins({"check", example("library.yaml"), "--set", library}, built_in);
#ifdef BBSIM_PYTHON
  check_margins({"check", example("python.yaml")}, built_in);
#endif
  // Quantized commands are not linear.
  const Folder folder;
  REQUIRE(bbsim({"sketch", example("arduino/pid.ino"), "-o", folder / "pid.so"}).exit_code == 0);
  CHECK(contains(bbsim({"check", example("arduino.yaml"), "--set",
                        "controller.library.file=" + (folder / "pid.so")})
                     .out,
                 "margins: no estimate: the controller is not linear about the reference"));
}

TEST_CASE("a library with inverse kinematics balances on three legs like the built-in law") {
  const Folder folder;
  const std::string legs = std::string("controller.library.file=") + BBSIM_EXAMPLE_LEGS;
  const std::string own = folder / "own.csv", built_in = folder / "built-in.csv";
  const Result run = bbsim({"run", example("three-legs.yaml"), "--set", legs, "-o", own});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  // The same law with tilts, which bbsim converts.
  REQUIRE(bbsim({"run", example("three-legs.yaml"), "--set", "controller.library=null", "--set",
                 "controller.pd={kp: [[0.9, 0], [0, -0.9]], kv: [[0.7, 0], [0, -0.7]]}", "--set",
                 "controller.drives=angle", "--set", "controller.limit=0.2", "-o", built_in})
              .exit_code == 0);
  const Result compared = bbsim({"compare", own, built_in, "--rtol", "0", "--atol", "1e-8"});
  CAPTURE(compared.out, compared.err);
  CHECK(compared.exit_code == 0);
  // The same library is refused under drives: angle.
  const Result refused = bbsim({"run", example("three-legs.yaml"), "--set", legs, "--set",
                                "controller.drives=angle", "-o", "-"});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "it commands the servos of three legs"));
}

TEST_CASE("check says whether three legs are turned or mirrored") {
  const std::string legs = std::string("controller.library.file=") + BBSIM_EXAMPLE_LEGS;
  const auto check = [&](const std::string& assignment) {
    const Result result =
        bbsim({"check", example("three-legs.yaml"), "--set", legs, "--set", assignment});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    return result.out;
  };
  CHECK_FALSE(contains(check("title=as it is"), "WARNING"));
  CHECK(contains(check("gimbal.three_servos.legs=[{angle: 60 deg}, {angle: 180 deg}, {angle: 300 "
                       "deg}]"),
                 "WARNING      its commands are turned by 60 deg; are the legs"));
  CHECK(contains(check("gimbal.three_servos.legs=[{angle: 0}, {angle: 240 deg}, {angle: 120 deg}]"),
                 "WARNING      its commands are mirrored; are two legs swapped"));
  const std::string turned = check("controller.sensor.rotation=90 deg");
  CHECK(contains(turned, "WARNING      phi: depends on y, but moves the ball along x\n"));
  CHECK(contains(turned, "WARNING      its commands are turned by 90 deg"));
}

TEST_CASE("your own program may command tilts on three legs, which bbsim inverts") {
  const Folder folder;
  const std::string own = folder / "own.csv", built_in = folder / "built-in.csv";
  const std::vector<std::string> three{
      "--set",
      "gimbal.three_servos={radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: "
      "0.11}",
      "--set", "output.columns=[t, x, y, phi, theta, servo_third, phi_command]"};
  const auto run = [&](const std::string& file, const std::string& into,
                       std::vector<std::string> more) {
    std::vector<std::string> words{"run", file, "-o", into};
    words.insert(words.end(), three.begin(), three.end());
    words.insert(words.end(), more.begin(), more.end());
    const Result result = bbsim(words);
    CAPTURE(result.err);
    CHECK(result.exit_code == 0);
  };
  run(example("library.yaml"), own, {"--set", library});
  run(config("step.yaml"), built_in, {});
  CHECK(bbsim({"compare", own, built_in, "--rtol", "0", "--atol", "0"}).exit_code == 0);
}

TEST_CASE("a library's path and name start at the scenario's folder") {
  const Folder folder;
  std::filesystem::create_directory(folder / "scene");
  std::filesystem::copy_file(BBSIM_EXAMPLE_LIBRARY, folder / "scene/libpid.so");
  std::filesystem::copy_file(example("library.yaml"), folder / "scene/library.yaml");
  for (const char* name : {"libpid.so", "./libpid.so"}) {
    const Result result = bbsim(
        {"check", "scene/library.yaml", "--set", std::string("controller.library.file=") + name},
        folder.path());
    CAPTURE(result.err);
    CHECK(result.exit_code == 0);
    CHECK(contains(result.out, "controller   the library opens, and makes a controller"));
  }
  const Result over = bbsim({"run", "library.yaml", "-o", "libpid.so"}, folder.path() / "scene");
  CHECK(over.exit_code == 2);
}

TEST_CASE("faults of a library are reported with the key's place") {
  struct Wrong {
    std::vector<std::string> words;
    std::string told;
  };
  const auto [words, told] = GENERATE(values<Wrong>({
      {with_misdeeds("0", "/no/such/library.so"), "which cannot be opened: /no/such/library.so"},
      {with_misdeeds("0", config("step.yaml")), "which cannot be opened"},
      {with_misdeeds("0", BBSIM_MISDEEDS_VERSION),
       "which is of version 99 of bbsim/controller.h; allowed: version 1: compile it again"},
      {with_misdeeds("0", BBSIM_MISDEEDS_LACK), "which has no function bbsim_controller_step"},
      {with_misdeeds("1"), "which makes no controller for this scenario: no such mode"},
      {{"run", example("library.yaml"), "--set", library, "--set",
        "controller.library.parameters.kd=1", "-o", "-"},
       "it takes the parameters kp, kv and ki"},
  }));
  const Result result = bbsim(words);
  CAPTURE(result.err);
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK(contains(result.err, "controller.library"));
  CHECK(contains(result.err, told));
}

TEST_CASE("a library error at a sample ends the run there") {
  const auto [mode, told] = GENERATE(table<std::string, std::string>(
      {{"2", "failed at sample 5 (t = 0.1 s): it returned 7: the plate is gone"},
       {"3", "failed at sample 5 (t = 0.1 s): its command is [0.01, nan]; allowed: finite"},
       {"13", "failed at sample 5 (t = 0.1 s): its column samples is nan; allowed"}}));
  const Result result = bbsim(with_misdeeds(mode));
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(contains(result.err, told));
  CHECK(std::count(result.out.begin(), result.out.end(), '\n') == 6);
}

TEST_CASE("a library that calls exit() ends bbsim with that code") {
  CHECK(bbsim(with_misdeeds("5")).exit_code == 7);
}

TEST_CASE("a library starts anew for each case of a sweep, with or without reset") {
  for (const char* mode : {"0", "4"}) {
    std::vector<std::string> words = with_misdeeds(mode);
    words[0] = "sweep";
    words.insert(words.end(),
                 {"--vary", "gravity=list:9,9.5,10", "--measure", "end_samples", "-j", "1"});
    const Result result = bbsim(words);
    CAPTURE(mode, result.err, result.out);
    CHECK(result.exit_code == 0);
    // The 11th sample is at the end.
    CHECK(contains(result.out, "0,9,done,,0.2,11\n1,9.5,done,,0.2,11\n2,10,done,,0.2,11\n"));
  }
}

}  // namespace bbsim_test::test_own_controller
