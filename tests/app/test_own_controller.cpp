// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The controllers of examples/controllers against the built-in law, and library controllers.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_own_controller {

namespace {

const std::string with_library = " --set 'controller.library.file=" BBSIM_EXAMPLE_LIBRARY "'";
const std::string in_c = "%examples/controllers/library.yaml" + with_library;
const std::string in_python = "%examples/controllers/python.yaml";
const std::string legs =
    "%examples/controllers/three-legs.yaml --set 'controller.library.file=" BBSIM_EXAMPLE_LEGS "'";

// The example sketch with its compiled library.
std::string sketch(const Folder& folder) {
  expect(0, "sketch %examples/controllers/arduino/pid.ino -o pid.so", folder);
  return "%examples/controllers/arduino.yaml --set 'controller.library.file=" +
         (folder / "pid.so") + "'";
}

std::string csv_of(const std::string& scene) {
  return expect(0, call("run " + scene +
                        " -o - --set 'output.columns=[t, x, y, vx, vy, spin, phi, theta, phi_rate, "
                        "theta_rate, phi_command, theta_command, x_measured, y_measured]'"))
      .out;
}

// The margins that a command prints, of each angle in turn.
std::vector<double> margins_of(const std::string& line) {
  const Result result = expect(0, call(line));
  std::vector<double> numbers;
  for (const char* angle : {"\n  phi        gain by ", "\n  theta      gain by "}) {
    const std::size_t begin = result.out.find(angle);
    REQUIRE(begin != std::string::npos);
    for (const char* before : {"gain by ", "down by ", "phase ", "delay "}) {
      const std::size_t at = result.out.find(before, begin);
      REQUIRE(at < result.out.find('\n', begin + 1));
      numbers.push_back(std::stod(result.out.substr(at + std::string(before).size())));
    }
  }
  return numbers;
}

std::string with_misdeeds(const std::string& mode, const std::string& file = BBSIM_MISDEEDS) {
  return " %examples/controllers/library.yaml --set 'controller.library.file=" + file +
         "' --set 'controller.library.parameters={mode: " + mode +
         "}' --set 'output.columns=[t, x, samples]' --set time.end=0.2 -o - -q";
}

}  // namespace

TEST_CASE("the example library reproduces the built-in PID's trajectory bit for bit") {
  CHECK(csv_of(in_c) == csv_of("@step.yaml"));
}

TEST_CASE("derivatives under your own controller are those of the built-in law") {
  const Folder folder;
  const auto gradient = [&](const std::string& scene) {
    expect(0,
           "run " + scene +
               " --set controller.sensor.resolution=0 --set time.end=2 --sensitivity gravity "
               "--measure end_x --summary s.json -o rows.csv",
           folder);
    return summary_of(folder, "s.json")["gradients"]["end_x"]["gravity"].get<double>();
  };
  const double wanted = gradient("@step.yaml");
  CHECK(gradient(in_c) == Approx(wanted).epsilon(1e-6));
#ifdef BBSIM_PYTHON
  CHECK(gradient(in_python) == Approx(wanted).epsilon(1e-6));
#endif
}

TEST_CASE("the sketch reproduces it too, with stepped servos") {
  const Folder folder;
  CHECK(csv_of(sketch(folder)) ==
        csv_of("@step.yaml --set 'controller.sampling.resolution=0.1 deg'"));
}

#ifdef BBSIM_PYTHON
TEST_CASE("the Python program reproduces it too, also with noise and dropouts") {
  CHECK(csv_of(in_python) == csv_of("@step.yaml"));
  const std::string worse =
      " --set 'controller.sensor.noise=0.5 mm' --set controller.sensor.dropout=0.2 --set "
      "'ball.position=[-0.1, 0.03]'";
  const std::string wanted = csv_of("@step.yaml" + worse);
  CHECK(csv_of(in_python + worse) == wanted);
  CHECK(csv_of(in_c + worse) == wanted);
}

TEST_CASE("parameters of a program are keys that can be set and swept") {
  const auto swept =
      rows(expect(0, call("sweep " + in_python +
                          " --vary controller.program.parameters.ki=list:0.2,0.35 --measure "
                          "end_x,max_x_integral -o - -q"))
               .out);
  const auto built_in = rows(
      call("sweep @step.yaml --vary controller.pid.ki.0.0=list:0.2,0.35 --measure end_x -o - -q")
          .out);
  // Only theta's ki differs, and the ball stays on the x axis.
  for (const std::size_t row : {1U, 2U}) CHECK(swept.at(row).at(5) == built_in.at(row).at(5));
  CHECK(swept[1][5] != swept[2][5]);
}
#endif

TEST_CASE("check estimates the built-in PID's margins for the same external law") {
  const std::vector<double> exact = margins_of("linearize @step.yaml");
  std::vector<std::string> own{in_c};
#ifdef BBSIM_PYTHON
  own.push_back(in_python);
#endif
  for (const std::string& scene : own) {
    const std::vector<double> estimated = margins_of("check " + scene);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      CAPTURE(scene, i, estimated[i], exact[i]);
      CHECK(std::abs(estimated[i] - exact[i]) < 0.02 * exact[i]);
    }
  }
  // Quantized commands are not linear.
  const Folder folder;
  expect(0, "check " + sketch(folder), folder, {},
         {"margins: no estimate: the controller is not linear about the reference"});
}

TEST_CASE("a library with inverse kinematics balances on three legs like the built-in law") {
  const Folder folder;
  expect(0, "run " + legs + " -o own.csv", folder);
  // The same law with tilts, which bbsim converts.
  expect(0,
         "run " + legs +
             " --set controller.library=null --set 'controller.pd={kp: [[0.9, 0], [0, -0.9]], kv: "
             "[[0.7, 0], [0, -0.7]]}' --set controller.drives=angle --set controller.limit=0.2 -o "
             "built-in.csv",
         folder);
  expect(0, "compare own.csv built-in.csv --rtol 0 --atol 1e-8", folder);
  // The same library is refused under drives: angle.
  expect(2, "run " + legs + " --set controller.drives=angle -o -", folder,
         {"it commands the servos of three legs"});
}

TEST_CASE("check says whether three legs are turned or mirrored") {
  const std::string warning = "WARNING      its commands are ";
  const auto [key, told] = GENERATE_COPY(table<std::string, std::vector<std::string>>({
      {"title=as it is", {"!WARNING"}},
      {"gimbal.three_servos.legs=[{angle: 60 deg}, {angle: 180 deg}, {angle: 300 deg}]",
       {warning + "turned by 60 deg; are the legs"}},
      {"gimbal.three_servos.legs=[{angle: 0}, {angle: 240 deg}, {angle: 120 deg}]",
       {warning + "mirrored; are two legs swapped"}},
      {"controller.sensor.rotation=90 deg",
       {"WARNING      phi: depends on y, but moves the ball along x\n",
        warning + "turned by 90 deg"}},
  }));
  expect(0, call("check " + legs + " --set '" + key + "'"), {}, told);
}

TEST_CASE("your own program may command tilts on three legs, which bbsim inverts") {
  const std::string three =
      " --set 'gimbal.three_servos={radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, "
      "height: 0.11}' --set 'output.columns=[t, x, y, phi, theta, servo_third, phi_command]' -o -";
  CHECK(expect(0, call("run " + in_c + three)).out ==
        expect(0, call("run @step.yaml" + three)).out);
}

TEST_CASE("a library's path and name start at the scenario's folder") {
  const Folder folder;
  std::filesystem::create_directory(folder / "scene");
  std::filesystem::copy_file(BBSIM_EXAMPLE_LIBRARY, folder / "scene/libpid.so");
  folder.write("scene/library.yaml",
               folder.read(BBSIM_SOURCE_DIR "/examples/controllers/library.yaml"));
  for (const std::string name : {"libpid.so", "./libpid.so"}) {
    expect(0, "check scene/library.yaml --set controller.library.file=" + name, folder, {},
           {"controller   the library opens, and makes a controller"});
  }
  expect(2, bbsim({"run", "library.yaml", "-o", "libpid.so"}, folder.path() / "scene"));
}

TEST_CASE("faults of a library are reported with the key's place") {
  const auto [scene, told] = GENERATE(table<std::string, std::string>({
      {with_misdeeds("0", "/no/such/library.so"), "which cannot be opened: /no/such/library.so"},
      {with_misdeeds("0", config("step.yaml")), "which cannot be opened"},
      {with_misdeeds("0", BBSIM_MISDEEDS_VERSION),
       "which is of version 99 of bbsim/controller.h; allowed: version 1: compile it again"},
      {with_misdeeds("0", BBSIM_MISDEEDS_LACK), "which has no function bbsim_controller_step"},
      {with_misdeeds("1"), "which makes no controller for this scenario: no such mode"},
      {" " + in_c + " --set controller.library.parameters.kd=1 -o -",
       "it takes the parameters kp, kv and ki"},
  }));
  CHECK(expect(2, call("run" + scene), {"controller.library", told}).out.empty());
}

TEST_CASE("a library error at a sample ends the run there") {
  const auto [mode, told] = GENERATE(
      table<std::string, std::string>({{"2", "it returned 7: the plate is gone"},
                                       {"3", "its command is [0.01, nan]; allowed: finite"},
                                       {"13", "its column samples is nan; allowed"}}));
  const Result result =
      expect(1, call("run" + with_misdeeds(mode)), {"failed at sample 5 (t = 0.1 s): " + told});
  CHECK(count(result.out, "\n") == 6);
}

TEST_CASE("a library that calls exit() ends bbsim with that code") {
  expect(7, call("run" + with_misdeeds("5")));
}

TEST_CASE("a library starts anew for each case of a sweep, with or without reset") {
  const std::string mode = GENERATE("0", "4");
  // The 11th sample is at the end.
  expect(0,
         call("sweep" + with_misdeeds(mode) +
              " --vary gravity=list:9,9.5,10 --measure end_samples -j 1"),
         {}, {"0,9,done,,0.2,11\n1,9.5,done,,0.2,11\n2,10,done,,0.2,11\n"});
}

}  // namespace bbsim_test::test_own_controller
