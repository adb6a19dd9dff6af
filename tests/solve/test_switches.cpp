// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Switches of servos and their backlash; test_every_scene.cpp has more of them.
#include <cmath>
#include <string>

#include "catch.hpp"
#include "solve/check_run.hpp"
#include "solve/scene_table.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_switches {

using namespace bbsim;

TEST_CASE("a servo that moves only between two nodes of a piece moves the ball") {
  const double frequency = GENERATE(300.0, 1000.0, 2000.0, 1e4);
  const double damping = GENERATE(0.5, 0.7, 1.0, 2.0);
  const std::string limit = GENERATE("rate_limit: 1", "acceleration_limit: 10");
  CAPTURE(frequency, damping, limit);
  const Scenario scene = parse_scenario(
      "ball: {radius: 0.02}\n"
      "gimbal: {servo: {natural_frequency: " +
          std::to_string(frequency) + ", damping: " + std::to_string(damping) + ", " + limit +
          "}}\n"
          "controller: {pd: {kv: 0, kp: [[1, 0], [0, -1]]}, drives: angle,\n"
          "  reference: {point: [0.1, 0]}, sampling: {period: 1}}\n"
          "time: {end: 0.5, step: 0.05}\n"
          "output: {columns: [t, x, y, vx]}\n",
      "fast.yaml");
  // When it leaves its rate limit it gives the ball 2 cm/s, within milliseconds.
  const Run pieces = run_in_memory(scene, Method::radau, {1e-8, 1e-10});
  const Run general = run_in_memory(scene, Method::bdf, {1e-10, 1e-12});
  REQUIRE(pieces.samples.size() == general.samples.size());
  double apart = 0;
  for (std::size_t i = 0; i < pieces.samples.size(); ++i) {
    const model::BallMotion &a = pieces.samples[i].ball, &b = general.samples[i].ball;
    apart = largest_finite(apart, {std::abs(a.x - b.x), std::abs(a.y - b.y)});
  }
  CHECK(apart < 1e-7);
}

TEST_CASE("backlash: a servo at rest that reverses leaves the plane where it is") {
  // At 0.2 s its command reverses; the plane waits until the gap is crossed, 2 ms later.
  const double end = GENERATE(0.2, 0.21);
  const Scenario scene = parse_scenario(
      R"(ball: {radius: 0.01, position: [-0.00912498342463637, -0.0004788716859636874],
       velocity: [-0.03344965261030668, -0.012901321040634423]}
gimbal: {servo: {natural_frequency: 500, damping: 1, backlash: 0.001}}
controller: {pd: {kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}, drives: angle,
  reference: {point: [0, 0]}, sampling: {period: 0.1}, limit: 0.2}
events: {lift_off: stop}
output: {columns: [t, x, y]}
time: {step: 0.1, end: )" +
          std::to_string(end) + "}\n",
      "turns.yaml");
  const Run run = run_in_memory(scene, Method::radau, {1e-8, 1e-10});
  CHECK(run.outcome.ending == solve::Ending::done);
  CHECK(run.outcome.occurrences.empty());
  REQUIRE(run.samples.size() > 2);
  CHECK(run.samples[2].gimbal.phi_ddot == 0);
}

TEST_CASE("backlash: a servo that starts with a rate moves neither plane nor ball") {
  Scenario scene = scene_called("backlash taken up and let go within a step");
  scene.ball.velocity = {0, 0};
  scene.controller->law = Law::pd;
  scene.controller->kp = scene.controller->kv = {};
  scene.gimbal.servo->backlash = 0.02;
  scene.gimbal.start.phi_rate = 0.05;
  const Run run = run_in_memory(scene, Method::automatic, {1e-9, 1e-11});
  CHECK(run.samples.front().ball.x_dot == 0);
  CHECK(run.samples.front().gimbal.phi == -0.1);
  CHECK(run.samples.front().gimbal.phi_dot == 0);
}

TEST_CASE("a check run has other stages and more steps between samples, on any rig") {
  Scenario scene = scene_called("a stop of the integrator next to a switch");
  const bool smooth = GENERATE(true, false);
  if (smooth) {
    scene = scene_called("a command that passes from one limit to the other within a step");
    scene.controller->limit.reset();
  }
  scene.events = {};
  const model::Model rig = model::assemble(scene, false);
  CHECK(rig.hybrid() == !smooth);
  const solve::OutputGrid grid(scene.time);
  std::vector<std::vector<double>> ends;
  std::size_t steps = 0;
  for (const solve::CheckRun how : {solve::CheckRun{8, 1}, {8, 3}, {12, 1}, {12, 3}}) {
    solve::Trajectory rows(rig.row_size());
    const auto outcome = solve::integrate_check_run(rig, how, {1e-7, 1e-9}, grid, rows, {});
    REQUIRE(outcome.ending == solve::Ending::done);
    const double* const last = rows.row(rows.rows() - 1);
    ends.emplace_back(last, last + rig.size());
    // A piece of such a rig takes one step or few.
    if (how.parts == 3 && !smooth) CHECK(outcome.statistics.steps > 2 * steps);
    steps = outcome.statistics.steps;
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      CHECK(ends[i] != ends[j]);
      // Within the tolerance, which the loop amplifies a few hundred times over thousands of
      // pieces.
      CHECK(std::abs(ends[i][0] - ends[j][0]) < 1e-4);
    }
  }
}

}  // namespace bbsim_test::test_switches
