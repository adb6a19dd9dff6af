// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks the tables of docs/reference/columns.md against the catalog. With BBSIM_WRITE_DOCS in the
// environment the test writes them.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "scenario/columns.hpp"

namespace bbsim_test::test_columns {

using namespace bbsim::scenario;

namespace {

const std::vector<std::string> sections = {"The ball", "The gimbal", "The controller",
                                           "Forces, torques and energy", "Motors"};

struct InDocs {
  std::string_view section;
  std::string_view available;
};

InDocs in_docs(const Column& column) {
  switch (column.needs) {
    case Needs::ball:
    case Needs::gamma:
    case Needs::orientation:
      return {"The ball", "always"};
    case Needs::gimbal:
    case Needs::accelerations:
      return {"The gimbal", "always"};
    case Needs::servos:
      return {"The gimbal", "`gimbal.servo`"};
    case Needs::third_servo:
      return {"The gimbal", "`gimbal.three_servos`"};
    case Needs::believed:
      return {"The gimbal", "`gimbal.servo.stepper`"};
    case Needs::legs_believed:
      return {"The gimbal", "steppers of `gimbal.three_servos`"};
    case Needs::controller:
    case Needs::commands:
      return {"The controller", "`controller`"};
    case Needs::samples:
      return {"The controller", "`controller.sampling`"};
    case Needs::own:
      return {"The controller", "`controller.program`, `.library`"};
    case Needs::dynamics:
      return {"Forces, torques and energy", "always"};
    case Needs::plate:
      return {"Forces, torques and energy", "`plate.inertia`"};
    case Needs::torques:
      return {"Motors", "torques move the gimbal"};
    case Needs::armature:
      return {"Motors", "the same, and `motor.dc`"};
    case Needs::coupled:
    case Needs::work:
      return {column.panel == "slip" ? "The ball" : "Forces, torques and energy",
              "[losses and others](#when-a-column-is-available)"};
    case Needs::pushed:
      return {column.panel == "push" ? "The ball" : "Forces, torques and energy", "`ball.push`"};
  }
  return {};
}

std::string row_of(const Column& column) {
  std::string unit(column.unit);
  if (const auto square = unit.find("^2"); square != std::string::npos) {
    unit.replace(square, 2, "²");
  }
  return "| `" + std::string(column.name) + "` | " + unit + " | " +
         std::string(in_docs(column).available) + " | " + std::string(column.meaning) + " |\n";
}

std::string table_of(const std::string& section) {
  std::string table = "| column | unit | available | meaning |\n|---|---|---|---|\n";
  for (const Column& column : catalogue) {
    if (in_docs(column).section == section) table += row_of(column);
  }
  if (section == "The controller") {
    table +=
        "| any other name | as its controller says | `controller.program`, `.library` | a number "
        "that [your own controller](controllers.md) gives beside its commands |\n";
  }
  return table;
}

// The page, with the first table after each of these headings replaced.
std::string with_tables(std::string page) {
  for (const std::string& section : sections) {
    const std::size_t heading = page.find("\n## " + section + "\n");
    REQUIRE(heading != std::string::npos);
    const std::size_t begin = page.find("\n| ", heading) + 1, end = page.find("\n\n", begin) + 1;
    page.replace(begin, end - begin, table_of(section));
  }
  return page;
}

}  // namespace

TEST_CASE("the page of columns has the catalogue's names, units and meanings") {
  const std::string file = std::string(BBSIM_SOURCE_DIR) + "/docs/reference/columns.md";
  std::stringstream page;
  page << std::ifstream(file).rdbuf();
  const std::string wanted = with_tables(page.str());
  if (std::getenv("BBSIM_WRITE_DOCS") != nullptr) std::ofstream(file) << wanted;
  CHECK(page.str() == wanted);
}

TEST_CASE("each column but time has a panel, and each panel's plot is among the replay's") {
  for (const Column& column : catalogue) {
    INFO(column.name);
    CHECK((column.panel == "none") == (column.name == "t"));
    CHECK(!column.symbol.empty());
  }
  std::set<std::string_view> used;
  for (const Panel& panel : panels) {
    if (panel.plot.empty()) continue;
    CHECK(std::ranges::count(plots, panel.plot) == 1);
    used.insert(panel.plot);
  }
  CHECK(used.size() == plots.size());
}

TEST_CASE("commands are placed with their targets") {
  const Column& command = *find_column("theta_command");
  CHECK(panel_of(command, "rad").name == "theta");
  CHECK(panel_of(command, "rad/s^2").name == "accelerations");
  CHECK(panel_of(command, "N m").name == "given_torques");
  CHECK(panel_of(command, "V").name == "voltages");
  CHECK(panel_of(*find_column("torque_phi"), "N m").name == "torques");
}

TEST_CASE("a column's name gives its axis") {
  for (const char* name : {"x", "vx", "phi_rate", "motor_torque_phi", "slip_x", "x_measured"}) {
    CHECK(axis_of(name) == 1);
  }
  for (const char* name : {"y", "vy", "theta", "torque_theta", "push_y"}) CHECK(axis_of(name) == 2);
  for (const char* name : {"t", "tilt", "servo_third", "push_power"}) CHECK(axis_of(name) == 0);
}

}  // namespace bbsim_test::test_columns
