// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "fit/data.hpp"
#include "fit/window_run.hpp"
#include "rig.hpp"
#include "scenario/columns.hpp"
#include "sweep/clock_shift.hpp"

namespace bbsim_test::test_windows {

using namespace bbsim;

namespace {

fit::Log even_log(double end, double step) {
  fit::Log log;
  log.name = "log";
  log.values.resize(1);
  const auto rows = static_cast<std::size_t>(std::lround(end / step));
  for (std::size_t i = 0; i <= rows; ++i) {
    log.times.push_back(static_cast<double>(i) * step);
    log.values[0].push_back(0);
  }
  return log;
}

// x, y, vx, vy and spin over a window that begins at `begin` of the scene's time.
std::vector<double> run_from(const Scenario& scenario, double begin, double end,
                             const fit::Start& start, const std::vector<double>& times) {
  fit::Window window;
  window.begin = begin;
  for (const double t : times) window.times.push_back(t - begin);
  const std::vector<const scenario::Column*> columns = {
      scenario::find_column("x"), scenario::find_column("y"), scenario::find_column("vx"),
      scenario::find_column("vy"), scenario::find_column("spin")};
  std::string why;
  const std::vector<double> values = fit::run_window(
      sweep::from_time(fit::prepared(scenario), begin, end), start, window.times, columns, why);
  INFO(why);
  REQUIRE(values.size() == 5 * times.size());
  return values;
}

}  // namespace

TEST_CASE("a log is cut into windows, and a share of them is held out") {
  const auto ten = fit::cut({even_log(10, 0.1)}, 2, 0.5, 4);
  REQUIRE(ten.size() == 5);
  CHECK(ten[0].first);
  CHECK_FALSE(ten[1].first);
  CHECK(ten[1].begin == Approx(2));
  CHECK(ten[4].times.size() == 21);  // includes the log's last row
  CHECK_FALSE(ten[0].held);
  CHECK(ten[1].held);
  CHECK_FALSE(ten[2].held);
  CHECK(ten[3].held);
  std::size_t rows = 0;
  for (const fit::Window& window : ten) rows += window.times.size();
  CHECK(rows == 101);

  CHECK(fit::cut({even_log(10.9, 0.1)}, 2, 0, 4).size() == 5);
  CHECK(fit::cut({even_log(11.5, 0.1)}, 2, 0, 4).size() == 6);
  CHECK(fit::cut({even_log(4, 0.1), even_log(6, 0.1)}, 2, 0, 4).size() == 5);
  CHECK(fit::cut({even_log(4, 1)}, 2, 0, 4).empty());
}

TEST_CASE("a scene started at a later time continues the scene") {
  const std::string scene = GENERATE(
      as<std::string>{}, true_rig,
      std::string("ball: {radius: 1 cm, position: [2 cm, 1 cm]}\n"
                  "gimbal: {motion: {phi: {table: {file: configs/recorded-angles.csv, time: t, "
                  "value: phi}}, theta: {ramp: {start: 0.01, rate: 0.002}}}}\n"
                  "time: {end: 4, step: 10 ms}\n"),
      std::string(
          "ball: {radius: 1 cm, push: {x: {pulse: {start: 2.2, duration: 0.3, value: "
          "10 mN}}}, mass: 0.01}\n"
          "gimbal: {motion: {phi: 0.01, theta: {sinusoid: {amplitude: 0.02, frequency: 3}}}}\n"
          "time: {end: 4, step: 10 ms}\n"));
  const ScenarioFamily family(Source{std::string(BBSIM_SOURCE_DIR) + "/scene.yaml", scene, {}});
  Scenario scenario = family.read({});
  const std::vector<double> times = {2, 2.3, 2.9, 3.7};
  const std::vector<double> whole = run_from(scenario, 0, 4, fit::start_of(scenario), times);
  const fit::Start at_two = {whole[0], whole[4], whole[8], whole[12], 0, 0, 0, 0, whole[16]};
  const std::vector<double> rest = run_from(scenario, 2, 4, at_two, times);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    CAPTURE(scene, i);
    CHECK(rest[i] == Approx(whole[i]).margin(1e-8));
  }
}

}  // namespace bbsim_test::test_windows
