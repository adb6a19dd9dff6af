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

}  // namespace bbsim_test::test_closed_forms
