// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include "base/error.hpp"
#include "catch.hpp"
#include "plot/columns.hpp"
#include "results.hpp"

namespace bbsim_test::test_columns {

using namespace bbsim;
using Catch::Matchers::Contains;

namespace {

// "x: x, x_reference | phi: phi"
std::string text_of(const std::vector<plot::PlannedPanel>& panels) {
  std::string text;
  for (const plot::PlannedPanel& panel : panels) {
    text += (text.empty() ? "" : " | ") + panel.name + ':';
    for (const plot::PlannedLine& line : panel.lines) text += ' ' + line.column;
  }
  return text;
}

double wave(double t) {
  return std::sin(t);
}

results::Result run_with(const std::vector<std::string>& names) {
  std::vector<std::pair<std::string, Function>> columns;
  columns.reserve(names.size());
  for (const std::string& name : names) columns.emplace_back(name, wave);
  return run_of(columns);
}

}  // namespace

TEST_CASE("related columns share a panel") {
  CHECK(text_of(plot::plan_panels({run_with({"x", "y", "gamma", "phi", "theta"})})) ==
        "x, y: x y | γ: gamma | φ, θ: phi theta");
  CHECK(text_of(plot::plan_panels(
            {run_with({"x", "y", "x_reference", "y_reference", "x_measured"})})) ==
        "x: x x_reference x_measured | y: y y_reference");
  CHECK(text_of(plot::plan_panels({run_with({"phi", "theta", "phi_command", "theta_command"})})) ==
        "φ: phi phi_command | θ: theta theta_command");
  CHECK(text_of(plot::plan_panels({run_with({"motor_torque_phi", "motor_torque_theta", "torque_phi",
                                             "normal_force", "friction_force"})})) ==
        "forces: normal_force friction_force | torque φ: torque_phi | "
        "motor torque: motor_torque_phi motor_torque_theta");
  CHECK(text_of(plot::plan_panels({run_with(
            {"phi_torque", "theta_torque", "slip_x", "slip_y", "total_energy", "energy_lost"})})) ==
        "motors' torque: phi_torque theta_torque | slip: slip_x slip_y | "
        "energy: total_energy energy_lost");
  CHECK(text_of(plot::plan_panels({run_with({"push_x", "push_y", "power", "push_power"})})) ==
        "push: push_x push_y | power: power push_power");
  CHECK(
      text_of(plot::plan_panels({run_with({"phi_torque", "phi_torque_asked", "theta_torque"})})) ==
      "φ motor's torque: phi_torque phi_torque_asked | θ motor's torque: theta_torque");
}

TEST_CASE("a run without y, or without any known column, is drawn") {
  CHECK(text_of(plot::plan_panels({run_with({"x", "vx", "phi", "phi_rate", "x_reference"})})) ==
        "x: x x_reference | vx: vx | φ: phi | φ': phi_rate");
  CHECK(text_of(plot::plan_panels({run_with({"voltage", "x_cam"})})) ==
        "voltage: voltage | x_cam: x_cam");
}

TEST_CASE("lines of very different size get separate panels") {
  const results::Result run = run_of({{"x", wave}, {"y", [](double t) { return 1e-4 * wave(t); }}});
  CHECK(text_of(plot::plan_panels({run})) == "x: x | y: y");
  // A constant one is flat in any panel.
  const results::Result still = run_of({{"x", wave}, {"y", [](double) { return 0.0; }}});
  CHECK(text_of(plot::plan_panels({still})) == "x, y: x y");
}

TEST_CASE("commands are drawn with what they command: angles or accelerations") {
  const Function angle = [](double t) { return 0.1 * std::sin(3 * t); };
  const Function acceleration = [](double t) { return -0.9 * std::sin(3 * t); };
  const results::Result driven =
      run_of({{"phi", angle}, {"phi_command", acceleration}, {"phi_acceleration", acceleration}});
  CHECK(plot::driven_quantity(driven) == Drives::acceleration);
  CHECK(text_of(plot::plan_panels({driven})) == "φ: phi | φ'': phi_acceleration phi_command");
  const results::Result servo = run_of({{"phi", angle}, {"phi_command", angle}});
  CHECK(plot::driven_quantity(servo) == Drives::angle);

  // The scenario decides.
  results::Result told = servo;
  told.scenario.emplace();
  told.scenario->controller.emplace().drives = Drives::acceleration;
  CHECK(plot::driven_quantity(told) == Drives::acceleration);
  told.scenario->controller->drives = Drives::torque;
  const auto panels = plot::plan_panels({told});
  CHECK(text_of(panels) == "φ: phi | φ command: phi_command");
  CHECK(panels[1].unit == plot::unit_of("phi_torque"));

  const results::Result both = run_of({{"phi_acceleration", acceleration},
                                       {"theta_acceleration", acceleration},
                                       {"phi", angle},
                                       {"theta", angle},
                                       {"phi_command", acceleration},
                                       {"theta_command", acceleration}});
  CHECK(text_of(plot::plan_panels({both})) ==
        "φ, θ: phi theta | φ'': phi_acceleration phi_command | "
        "θ'': theta_acceleration theta_command");
}

TEST_CASE("a comparison has one quantity per panel") {
  const results::Result run = run_with({"x", "y", "x_reference", "vx", "vy", "phi", "phi_command"});
  CHECK(text_of(plot::plan_panels({run, run})) ==
        "x: x x_reference | y: y | vx: vx | vy: vy | φ: phi | φ command: phi_command");
}

TEST_CASE("columns are drawn as requested, or the reason is given") {
  const results::Result run = run_with({"x", "y", "phi", "theta", "vx"});
  CHECK(text_of(plot::plan_panels({run}, {{"y", "x"}, {"theta"}})) == "y, x: y x | θ: theta");
  CHECK_THROWS_WITH(plot::plan_panels({run}, {{"x", "phi"}}), Contains("has another unit"));
  CHECK_THROWS_WITH(plot::plan_panels({run}, {{"thta"}}), Contains("did you mean theta?"));
  CHECK_THROWS_WITH(plot::plan_panels({run}, {{""}}), Contains("found nothing"));
  CHECK_THROWS_WITH(plot::plan_panels({run}, {{"t"}}), Contains("over which"));
  const results::Result empty = run_of({{"x", wave}, {"z", [](double) { return NAN; }}});
  CHECK_THROWS_WITH(plot::plan_panels({empty}, {{"z"}}), Contains("no finite number"));
  CHECK(text_of(plot::plan_panels({empty})) == "x: x");
}

TEST_CASE("angles are drawn in degrees, turns of the ball in radians") {
  CHECK(plot::unit_of("phi").text == "°");
  CHECK(plot::unit_of("phi").factor == Approx(57.29577951));
  CHECK(plot::unit_of("gamma").text == "rad");
  CHECK(plot::unit_of("theta_acceleration").text == "°/s²");
  CHECK(plot::unit_of("friction_demand").text.empty());
  CHECK(plot::unit_of("x").text == "m");
  CHECK(plot::unit_of("voltage").text.empty());
}

TEST_CASE("no unit is assumed for a table of unknown origin, whatever its column names") {
  std::vector<results::Result> runs{run_with({"t", "x", "phi"})};
  CHECK(plot::unit_of(runs, "x").text == "m");
  runs.push_back(runs.front());
  runs.back().units_known = false;
  for (const char* name : {"t", "x", "phi"}) {
    CHECK(plot::unit_of(runs, name).text.empty());
    CHECK(plot::unit_of(runs, name).factor == 1);
  }
}

TEST_CASE("a column known only to the file has the file's unit") {
  results::Result run = run_with({"x", "position_error", "angle"});
  run.columns[2].unit = "m";
  run.columns[3].unit = "rad";
  const auto panels = plot::plan_panels({run});
  CHECK(text_of(panels) == "x: x | error of x, y: position_error | angle: angle");
  CHECK(panels[1].unit.text == "m");
  CHECK(panels[2].unit.text == "°");
}

}  // namespace bbsim_test::test_columns
