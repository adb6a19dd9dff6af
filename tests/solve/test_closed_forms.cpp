// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Closed forms of docs/explanation/model.md, and properties of every integration.
#include <atomic>
#include <cmath>
#include <limits>

#include "catch.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_closed_forms {

using namespace bbsim;

namespace {

Scenario still_plane(double phi, double theta) {
  Scenario scene;
  scene.ball.radius = 0.01;
  scene.gimbal.motion = {{phi}, {theta}};
  scene.time = {3, 0.1};
  return scene;
}

const auto every_method = [] {
  return GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
};

}  // namespace

TEST_CASE("a fixed incline: constant acceleration, constant spin") {
  const Method method = every_method();
  Scenario scene = still_plane(0.2, -0.3);
  scene.ball.position = {0.1, -0.2};
  scene.ball.velocity = {0.3, 0.4};
  scene.ball.spin = 20;
  const Run run = run_in_memory(scene, method, {1e-10, 1e-12});
  REQUIRE(run.outcome.ending == solve::Ending::done);
  const double g = scene.gravity;
  for (const model::Sample& sample : run.samples) {
    const double t = sample.t;
    const double x = 0.1 + 0.3 * t + 5.0 / 14 * g * std::sin(0.2) * t * t;
    const double y = -0.2 + 0.4 * t - 5.0 / 14 * g * std::cos(0.2) * std::sin(-0.3) * t * t;
    // Lengths up to 10 m at rtol 1e-10, times ten for the sum of local errors.
    CHECK(std::abs(sample.ball.x - x) < 1e-8);
    CHECK(std::abs(sample.ball.y - y) < 1e-8);
    CHECK(std::abs(sample.ball.gamma_dot - 20) < 1e-8);
    CHECK(std::abs(sample.gamma - 20 * t) < 1e-7);
  }
}

TEST_CASE("a plane turning at a constant rate: hyperbolic along it, circular across it") {
  const Method method = every_method();
  const double rate = 2, g = 9.80665, x0 = 0.05, vy0 = 0.1, r = 0.01, spin0 = 5;
  Scenario scene = still_plane(0, 0);
  scene.gimbal.motion->phi = {Ramp{0, rate}};
  scene.ball.position = {x0, 0};
  scene.ball.velocity = {0, vy0};
  scene.ball.spin = spin0;
  const Run run = run_in_memory(scene, method, {1e-10, 1e-12});
  const double k = rate * std::sqrt(5.0 / 7), q = rate * std::sqrt(2.0 / 7);
  // x'(0) = 0 fixes the coefficient of sinh.
  const double b = 5 * g / (12 * rate * k);
  for (const model::Sample& sample : run.samples) {
    const double t = sample.t;
    const double x = x0 * std::cosh(k * t) + b * std::sinh(k * t) -
                     5 * g / (12 * rate * rate) * std::sin(rate * t);
    const double vy = vy0 * std::cos(q * t) + r * spin0 * rate * (2.0 / 7) / q * std::sin(q * t);
    // Position and error grow alike, as e^(k t): each step may leave rtol of the position.
    const double of_all_steps =
        1e-10 * static_cast<double>(run.outcome.statistics.steps) * std::abs(x);
    CHECK(std::abs(sample.ball.x - x) < 1e-9 + of_all_steps);
    CHECK(std::abs(sample.ball.y_dot - vy) < 1e-8);
  }
}

TEST_CASE("a ball at rest on a level plane stays there, exactly") {
  const Method method = every_method();
  Scenario scene = still_plane(0, 0);
  scene.ball.position = {0.1, 0.2};
  scene.time = {1e6, 1e5};
  const Run run = run_in_memory(scene, method, {1e-8, 1e-10});
  CHECK(run.outcome.ending == solve::Ending::done);
  CHECK(run.samples.size() == 11);
  CHECK(run.outcome.statistics.steps < 100);
  for (const model::Sample& sample : run.samples) {
    CHECK(sample.ball.x == 0.1);
    CHECK(sample.ball.y == 0.2);
    CHECK(sample.gamma == 0);
  }
}

TEST_CASE("output times are multiples of the step, and the end time") {
  Scenario scene = still_plane(0, 0);
  const auto times = [&](double end, double step) {
    const solve::OutputGrid grid(OutputTimes{end, step});
    std::vector<double> list;
    for (std::size_t i = 0; i < grid.size(); ++i) list.push_back(grid[i]);
    return list;
  };
  CHECK(times(1, 0.25) == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK(times(1, 0.4) == std::vector<double>{0, 0.4, 0.8, 1});
  CHECK(times(1, 5) == std::vector<double>{0, 1});
  CHECK(times(10, 0.01).size() == 1001);  // not 1,002 because of the rounding of 0.01
  CHECK(times(10, 0.01)[700] == 700 * 0.01);
  CHECK(times(21, 0.1).size() == 211);
  CHECK(times(0.3, 0.1).size() == 4);  // 0.3 / 0.1 is 2.9999999999999996
  CHECK(times(1e-9, 1e-10).size() == 11);
}

TEST_CASE("the result does not depend on the requested rows") {
  const Method method = every_method();
  Scenario scene = scenario_named("fig2a");
  const Run coarse = run_in_memory(scene, method, {1e-9, 1e-11});
  scene.time.step = 0.025;
  const Run fine = run_in_memory(scene, method, {1e-9, 1e-11});
  REQUIRE(fine.samples.size() == 401);
  for (std::size_t i = 0; i < coarse.samples.size(); ++i) {
    CHECK(fine.samples[4 * i].ball.x == coarse.samples[i].ball.x);
    CHECK(fine.samples[4 * i].gamma == coarse.samples[i].gamma);
  }
}

TEST_CASE("the integrator does not step over a pulse in a table") {
  const Method method = every_method();
  // Level for 500 s, a bump of 0.1 rad that lasts 4 ms, level again. The ball gains the integral of
  // (5/7) g sin(phi) and of the rocking terms, which cancel over the whole bump except for x
  // phi'^2. A step across it would leave the ball at rest.
  Table bump{"bump.csv", {}, {}};
  for (const double t : {0.0, 100.0, 200.0, 300.0, 400.0, 499.0, 499.9, 499.99, 499.998, 499.999,
                         500.0, 500.001, 500.002, 500.01, 500.1, 501.0, 600.0, 700.0, 1000.0}) {
    bump.times.push_back(t);
    bump.values.push_back(t == 500.0 ? 0.1 : 0.0);
  }
  Scenario scene = still_plane(0, 0);
  scene.gimbal.motion->phi = {bump};
  scene.time = {1000, 1};
  const Run run = run_in_memory(scene, method, {1e-9, 1e-12});
  REQUIRE(run.outcome.ending == solve::Ending::done);
  CHECK(run.outcome.statistics.steps > bump.times.size());
  const Run finer = run_in_memory(scene, method, {1e-11, 1e-14});
  const double end = finer.samples.back().ball.x;
  CHECK(std::abs(end) > 1e-4);
  CHECK(std::abs(run.samples.back().ball.x - end) < 1e-4 * std::abs(end));
}

TEST_CASE("a stop request ends the run and keeps its rows") {
  const std::atomic<bool> stop{true};
  const Run run = run_in_memory(scenario_named("fig2a"), Method::automatic, {}, true, {&stop, {}});
  CHECK(run.outcome.ending == solve::Ending::interrupted);
  CHECK(run.samples.size() == run.outcome.rows);
  CHECK(run.outcome.rows >= 1);
  CHECK(run.outcome.rows < 101);
}

}  // namespace bbsim_test::test_closed_forms
