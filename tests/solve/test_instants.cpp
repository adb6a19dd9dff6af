// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows, samples and stops at times that are nearly equal, or equal up to rounding.
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_instants {

using namespace bbsim;

namespace {

const Method methods[] = {Method::radau, Method::bdf, Method::adams};

// A sampled loop; times in units of `unit`, s.
Scenario sampled(double unit, double end, double step, double period, double sensor_delay = 0) {
  Scenario scene = parse_scenario(
      "ball: {radius: 0.01, velocity: [1, 0]}\n"
      "time: {end: 1, step: 0.1}\n"
      "controller: {pd: {kv: 0.5, kp: 0.5}, drives: acceleration, reference: {point: [0, 0]},"
      " sampling: {period: 0.1}, sensor: {}}\n",
      "sampled.yaml");
  scene.time = {end * unit, step * unit};
  scene.controller->sampling->period = period * unit;
  scene.controller->sensor->delay = sensor_delay * unit;
  return scene;
}

void check_whole(const Scenario& scene, std::size_t rows) {
  for (const Method method : methods) {
    CAPTURE(int(method), scene.time.end, scene.time.step);
    const Run run = run_in_memory(scene, method, {1e-8, 1e-10});
    CAPTURE(run.outcome.reason);
    CHECK(run.outcome.ending == solve::Ending::done);
    REQUIRE(run.samples.size() == rows);
    CHECK(solve::OutputGrid(scene.time).size() == rows);
    // The ball rolls along x, which its controller hardly affects in so short a time.
    for (std::size_t i = 1; i < rows; ++i) {
      const double t = run.samples[i].t;
      CHECK(t > run.samples[i - 1].t);
      CHECK(run.samples[i].ball.x == Approx(t).epsilon(1e-3));
    }
  }
}

}  // namespace

TEST_CASE("a row next to the end and its sample is kept") {
  // The tenth row is 5e-15 s before the end.
  check_whole(sampled(1e-7, 10, 0.999999995, 1), 12);
  // Between two samples, 1e-15 s from each.
  check_whole(sampled(1e-15, 100, 0.5, 1), 201);
}

TEST_CASE("scenes of any length are sampled in the same way") {
  const double unit = GENERATE(1e-12, 1e-9, 1e-3, 1.0, 1e3);
  Scenario scene = sampled(unit, 1, 0.1, 0.02, 0.03);
  scene.ball.velocity = {1e-3 / unit, 0};
  scene.controller->kv = scene.controller->kp = {};  // without gains it rolls on
  // A delay of a period and a half: the measurement lies between samples.
  const Run run = whole_run(scene, Method::radau, {1e-8, 1e-10});
  REQUIRE(run.samples.size() == 11);
  for (std::size_t i = 1; i < run.samples.size(); ++i) {
    const double seen = (static_cast<double>(i) * 0.1 - 0.03) * unit;
    CHECK(run.samples[i].measured[0] == Approx(scene.ball.velocity[0] * seen).epsilon(1e-9));
  }
}

TEST_CASE("rows and samples equal up to rounding coincide") {
  // 0.1 i and 0.02 n: each row shows the state after the sample of the same time.
  const Run run = run_in_memory(sampled(1, 3, 0.1, 0.02), Method::radau, {1e-8, 1e-10});
  REQUIRE(run.samples.size() == 31);
  for (const model::Sample& row : run.samples) {
    CHECK(row.measured[0] == Approx(row.ball.x).margin(1e-14));
  }
}

TEST_CASE("stops an ulp apart, or next to the end, coincide") {
  const double here = 0.3, next = std::nextafter(here, 1.0), last = std::nextafter(1.0, 0.0);
  Scenario scene;
  scene.ball.radius = 0.01;
  scene.time = {1, 0.1};
  scene.gimbal.motion = {{Table{"", {0, here, 0.6, last, 2}, {0, 0.1, 0, 0.1, 0}}},
                         {Table{"", {0, next, 0.7, 1.5, 2}, {0, -0.1, 0, 0.1, 0}}}};
  CHECK(model::assemble(scene, false).stops == std::vector<double>{here, 0.6, 0.7});
  // A monitored scene is integrated from switch to switch.
  scene.events.lift_off = GENERATE(std::optional<OnEvent>{}, std::optional(OnEvent::note));
  const Run first = run_in_memory(scene, Method::radau, {1e-10, 1e-12});
  for (const Method method : methods) {
    CAPTURE(int(method));
    const Run run = run_in_memory(scene, method, {1e-10, 1e-12});
    CAPTURE(run.outcome.reason);
    CHECK(run.outcome.ending == solve::Ending::done);
    REQUIRE(run.samples.size() == 11);
    // Some hundred steps of 1e-10 each.
    CHECK(std::abs(run.samples.back().ball.x - first.samples.back().ball.x) < 1e-7);
  }
}

TEST_CASE("an output grid has no time twice, for any number of rows") {
  for (const double count : {1e6, 1e8, 999999999.0}) {
    for (const double off : {0.0, 1e-9, -1e-9, 1e-16, -1e-16, 2.3e-16}) {
      const double step = 1e-3, end = count * step * (1 + off);
      const solve::OutputGrid grid(OutputTimes{end, step});
      const std::size_t rows = grid.size();
      CAPTURE(count, off, rows);
      CHECK(grid[rows - 1] == end);
      CHECK(grid[rows - 2] < end);
      CHECK(std::abs(static_cast<double>(rows) - count) <= 2);
    }
  }
}

TEST_CASE("output times are multiples of the step, and the end time") {
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

}  // namespace bbsim_test::test_instants
