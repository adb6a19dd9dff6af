// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys of a controller that is not built in.
#include "catch.hpp"
#include "scenario/columns.hpp"
#include "support/reading.hpp"
#include "support/text.hpp"

namespace bbsim_test::test_own_controller {

using namespace bbsim;
using namespace bbsim::test;

namespace {

std::string scene(const std::string& controller, const std::string& rest = "") {
  return "ball: {radius: 0.02}\n"
         "gimbal: {servo: {natural_frequency: \"5 Hz\", damping: 0.8}}\n"
         "controller:\n"
         "  " +
         controller +
         "\n"
         "  drives: angle\n"
         "  reference: {point: [0, 0]}\n"
         "  sampling: {period: 0.02}\n"
         "time: {end: 1, step: 0.1}\n" +
         rest;
}

}  // namespace

TEST_CASE("a program and a library are read, with their parameters") {
  const Scenario with_program = parse(
      scene("program: {command: [python3, -u, \"my pid.py\", 5], parameters: {kp: 0.7, n_2: -3}, "
            "timeout: \"20 ms\"}"),
      {"controller.program.parameters.kp=0.8", "controller.program.parameters.new=1"});
  CHECK(with_program.controller->law == Law::own);
  const OwnController& own = *with_program.controller->own;
  const auto& read = std::get<ControllerProgram>(own.by);
  CHECK(read.command == std::vector<std::string>{"python3", "-u", "my pid.py", "5"});
  CHECK(read.timeout == 0.02);
  CHECK(read.start_timeout == 5);
  REQUIRE(own.parameters.size() == 3);
  CHECK(own.parameters[0].name == "kp");
  CHECK(own.parameters[0].value == 0.8);
  CHECK(own.parameters[1].value == -3);
  CHECK(own.parameters[2].name == "new");

  const Scenario slow = parse(scene("program: {command: [a], timeout: \"1 min\"}"));
  CHECK(std::get<ControllerProgram>(slow.controller->own->by).start_timeout == 60);

  const Scenario with_library = parse_scenario(
      scene("library: {file: ./libpid.so, parameters: {kp: 1}}"), "some/folder/scenario.yaml");
  CHECK(std::get<ControllerLibrary>(with_library.controller->own->by).file == "./libpid.so");
  CHECK(with_library.controller->own->folder == "some/folder");
}

TEST_CASE("a program at a sketch's serial line is read") {
  const Scenario scenario = parse(
      scene("library: {file: a.so, wiring: w.yaml, serial: {command: [pc], period: \"30 Hz\", "
            "delay: \"5 ms\", parameters: {kp: 2}}}"),
      {"controller.library.serial.parameters.kp=3"});
  const SerialProgram& serial = *std::get<ControllerLibrary>(scenario.controller->own->by).serial;
  CHECK(serial.program.command == std::vector<std::string>{"pc"});
  CHECK(serial.period == Approx(1 / 30.0));
  CHECK(serial.delay == 0.005);
  CHECK(serial.parameters.at(0).value == 3);
}

TEST_CASE("columns of other names belong to your own controller") {
  const Scenario own =
      parse(scene("program: {command: [a]}", "output: {columns: [t, u_integral, x, V2]}"));
  CHECK(scenario::own_columns(own) == std::vector<std::string>{"u_integral", "V2"});
  CHECK(scenario::find_column("u_integral")->needs == scenario::Needs::own);
  // The names are now known, but still invalid for scenes without such a controller.
  const std::string built_in =
      scene("pd: {kv: 0, kp: 0}", "output: {columns: [t, u_integral, phi_comand]}");
  CHECK(contains(errors(built_in), "output.columns.1: found u_integral; allowed: one of t, x"));
  CHECK(contains(errors(built_in), "did you mean phi_command?"));
}

}  // namespace bbsim_test::test_own_controller
