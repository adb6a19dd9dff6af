// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Extremes of a sweep's cases between their rows, with each engine.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "record/rows.hpp"
#include "solve/integrate.hpp"
#include "study/reference.hpp"
#include "support/greatest_of.hpp"
#include "support/sweep_setup.hpp"
#include "sweep/runners.hpp"
#include "sweep/sweep.hpp"

namespace bbsim_test::test_extremes {

using namespace bbsim;
using namespace bbsim::sweep;
using bbsim_test::greatest_of;

namespace {

const std::vector<std::string> extremes{"max_distance", "max_tilt", "max_tilt_rate"};
const std::vector<std::string> loop_extremes{"max_distance", "max_tilt", "max_tilt_rate",
                                             "max_tracking_error"};

// The measures of case `number`, from many rows at the finest tolerance.
std::vector<double> from_many_rows(const SweepTask& task, std::size_t number) {
  Scenario scenario = task.family.read(task.plan.settings(number));
  scenario.time.step = scenario.time.end / 40000;
  const model::Model model = model::assemble(scenario, false);
  const model::BallConstants constants = model::constants_of(scenario);
  const solve::OutputGrid grid(scenario.time);
  solve::Trajectory rows(model.row_size());
  REQUIRE(solve::integrate(model, Method::radau, {1e-13, 1e-15}, grid, rows).ending ==
          solve::Ending::done);
  std::vector<const scenario::Column*> columns;
  for (const scenario::Measure& measure : task.measures) columns.push_back(measure.column);
  record::Rows row(std::move(columns));
  row.begin(model, constants);
  std::vector<std::vector<double>> values(task.measures.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double t = grid[i];
    row.evaluate(&t, rows.row(i), 1);
    for (std::size_t m = 0; m < task.measures.size(); ++m) values[m].push_back(row[m][0]);
  }
  std::vector<double> greatest;
  for (const auto& of_measure : values) greatest.push_back(greatest_of(of_measure));
  return greatest;
}

// Largest difference of any case from many rows, absolute: m, rad, rad/s.
double error_of(const CaseResults& results, const SweepTask& task) {
  double largest = 0;
  const std::size_t numbers = 1 + task.measures.size();
  for (std::size_t i = 0; i < task.plan.cases(); ++i) {
    CHECK(results.status[i].word == "done");
    const std::vector<double> expected = from_many_rows(task, i);
    for (std::size_t m = 0; m < expected.size(); ++m) {
      CAPTURE(i, task.measures[m].name, results.numbers[i * numbers + 1 + m], expected[m]);
      const double error = std::abs(results.numbers[i * numbers + 1 + m] - expected[m]);
      CHECK(error < 1e-8);
      largest = std::max(largest, error);
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("maxima between rows a second apart, by single runs and in lanes") {
  const std::vector<std::string> tight{"time.step=1", "solver.rtol=1e-11", "solver.atol=1e-13"};
  const auto check = [](const Setup& setup, double close) {
    CHECK(error_of(run_all(*single_runner(setup.task), setup.task), setup.task) < close);
  };
  // Rates up to 0.2 rad/s; between step ends the error is a hundred times the tolerance.
  check({"configs/fig2b.yaml",
         {{"controller.pd.kv.0.0", "uniform:0.8:1.2"},
          {"gimbal.servo.natural_frequency", "uniform:8:30"}},
         tight,
         loop_extremes,
         6},
        1e-9);
  check({"configs/fig2a.yaml",
         {{"gimbal.motion.phi.sinusoid.amplitude", "uniform:0.005:0.5"},
          {"gimbal.motion.theta.sinusoid.frequency", "uniform:0.5:3"},
          {"ball.velocity.0", "uniform:-1:1"}},
         tight,
         extremes,
         8},
        1e-9);
  check({"configs/fig2b.yaml",
         {{"controller.pd.kv.0.0", "uniform:0.8:1.2"}},
         tight,
         {"max_x", "max_friction_force", "max_phi_rate", "max_spin", "max_power"},
         3},
        1e-9);
  std::vector<std::string> planar = tight;
  planar.insert(planar.end(), {"gimbal.motion.phi=0", "ball.position=[0, 0.1]"});
  check({"configs/fig2a.yaml",
         {{"gimbal.motion.theta.sinusoid.phase", "uniform:0:3"}},
         planar,
         extremes,
         4},
        1e-10);
  // The fastest mode of these loops still allows lanes at a fine enough tolerance.
  const Setup stiff("tests/data/scenarios/stiff-servo.yaml",
                    {{"controller.pd.kv.0.0", "uniform:0.035:0.065"},
                     {"controller.pd.kp.1.1", "uniform:-0.065:-0.035"}},
                    {"time.step=1", "solver.rtol=1e-9", "solver.atol=1e-11"},
                    {"max_distance", "max_tilt", "max_tracking_error"}, 11);
  REQUIRE(can_use_lanes(stiff.task));
  CHECK(error_of(run_all(*lane_runner(stiff.task), stiff.task), stiff.task) < 1e-8);
}

TEST_CASE("a mean over the rows changes no maximum between them") {
  std::vector<std::string> names = loop_extremes;
  const std::vector<std::string> set{"time.step=1", "solver.rtol=1e-10", "solver.atol=1e-12"};
  const std::vector<Variation> vary{{"controller.pd.kv.0.0", "uniform:0.8:1.2"}};
  const Setup without("configs/fig2b.yaml", vary, set, names, 4);
  names.emplace_back("rms_tracking_error");
  const Setup with("configs/fig2b.yaml", vary, set, names, 4);
  const CaseResults a = run_all(*single_runner(without.task), without.task);
  const CaseResults b = run_all(*single_runner(with.task), with.task);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t m = 0; m < 5; ++m) CHECK(a.numbers[i * 5 + m] == b.numbers[i * 6 + m]);
  }
}

TEST_CASE("extremes in lanes agree with single runs within the tolerance") {
  const std::string scene = GENERATE("configs/fig2b.yaml", "configs/hold.yaml");
  const double rtol = GENERATE(1e-4, 1e-7);
  char tolerance[2][40];
  std::snprintf(tolerance[0], sizeof tolerance[0], "solver.rtol=%g", rtol);
  std::snprintf(tolerance[1], sizeof tolerance[1], "solver.atol=%g", 1e-2 * rtol);
  const std::vector<Variation> vary{{"ball.velocity.0", "uniform:-0.2:0.2"},
                                    {"controller.pd.kv.0.0", "uniform:0.8:1.2"}};
  const Setup coarse(scene, vary, {"time.step=1", tolerance[0], tolerance[1]}, loop_extremes, 16);
  const Setup fine(scene, vary, {"time.step=1", "solver.rtol=1e-12", "solver.atol=1e-14"},
                   loop_extremes, 16);
  REQUIRE(can_use_lanes(coarse.task));
  const CaseResults lanes = run_all(*lane_runner(coarse.task), coarse.task);
  const CaseResults exact = run_all(*single_runner(fine.task), fine.task);
  for (std::size_t i = 0; i < lanes.numbers.size(); ++i) {
    CAPTURE(scene, rtol, i);
    CHECK(lanes.numbers[i] == Approx(exact.numbers[i]).epsilon(10 * rtol).margin(0.3 * rtol));
  }
}

TEST_CASE("extremes of single runs do not depend on the output step, bit for bit") {
  const auto runs = [](const std::string& step, const std::string& scene,
                       const Variation& variation, const std::vector<std::string>& names) {
    const Setup setup(scene, {variation}, {"time.step=" + step}, names, 3);
    return run_all(*single_runner(setup.task), setup.task).numbers;
  };
  for (const char* const step : {"0.01", "0.5"}) {
    const Variation motion{"gimbal.motion.phi.sinusoid.amplitude", "uniform:0.005:0.015"};
    CHECK(runs("1", "configs/fig2a.yaml", motion, extremes) ==
          runs(step, "configs/fig2a.yaml", motion, extremes));
    const Variation gain{"controller.pd.kv.0.0", "uniform:0.8:1.2"};
    CHECK(runs("1", "configs/fig2b.yaml", gain, loop_extremes) ==
          runs(step, "configs/fig2b.yaml", gain, loop_extremes));
    const Variation noise{"controller.sensor.noise", "uniform:1e-4:3e-4"};
    CHECK(runs("1", "configs/rig.yaml", noise, {"max_motor_power", "min_x", "max_tilt"}) ==
          runs(step, "configs/rig.yaml", noise, {"max_motor_power", "min_x", "max_tilt"}));
  }
}

TEST_CASE("extremes agree with a solution in quad precision") {
  const Setup setup("configs/fig2b.yaml", {{"ball.mass", "uniform:1:2"}},
                    {"time.end=2", "time.step=2", "solver.rtol=1e-12", "solver.atol=1e-14"},
                    {"max_distance", "max_tracking_error"}, 1);
  const CaseResults results = run_all(*single_runner(setup.task), setup.task);
  Scenario scenario = setup.family.read(setup.plan.settings(0));
  scenario.time.step = 1e-3;
  const model::Model model = model::assemble(scenario, false);
  const solve::OutputGrid grid(scenario.time);
  const study::ReferenceSolution exact = study::solve_reference(model, grid);
  REQUIRE(exact.rows() == grid.size());
  std::vector<double> distances, errors;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double x = static_cast<double>(exact.row(i)[0]), y = static_cast<double>(exact.row(i)[1]);
    const auto [x_wanted, y_wanted] =
        std::get<model::ClosedLoop<model::Shape::full, Drives::angle>>(model.system)
            .reference()
            .at(grid[i]);
    distances.push_back(std::hypot(x, y));
    errors.push_back(std::hypot(x - x_wanted.value, y - y_wanted.value));
  }
  CHECK(results.numbers[1] == Approx(greatest_of(distances)).epsilon(1e-11));
  CHECK(results.numbers[2] == Approx(greatest_of(errors)).epsilon(1e-11));
}

}  // namespace bbsim_test::test_extremes
