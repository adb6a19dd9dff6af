// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Closed loops along reference paths; test_every_scene.cpp has each kind of path.
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_reference_paths {

using namespace bbsim;

namespace {

// Poles about home from (M13), in 1/s: -22.4 +- 14.6i from the servo, -3.84 and -1.48.
Scenario follows(const Reference& reference) {
  Scenario scene;
  scene.ball.radius = 0.01;
  scene.ball.position = {0.01, 0.02};
  scene.gimbal.servo = Servo{31, 0.9};
  Controller controller;
  controller.kv = {{{0.6, 0}, {0, -0.6}}};
  controller.kp = {{{0.6, 0}, {0, -0.6}}};
  controller.drives = Drives::angle;
  controller.reference = reference;
  scene.controller = controller;
  scene.time = {8, 0.05};
  return scene;
}

}  // namespace

TEST_CASE("the ball comes to rest where the waypoints end") {
  const bool rest = GENERATE(false, true);
  const std::vector<Pair> points{{0, 0}, {0.06, 0.02}, {-0.04, 0.01}};
  Scenario scene = follows(WaypointReference{points, {0, 2, 4}, rest});
  scene.time = {20, 0.5};
  const Run run = run_in_memory(scene, Method::radau, {1e-8, 1e-10});
  const model::Sample& last = run.samples.back();
  CHECK(last.reference == Pair{-0.04, 0.01});
  // After 16 s the slowest pole has left e^-23.7 of what existed at 4 s, at most 0.2 m. The
  // integration may leave ten local errors of rtol times 0.2 m.
  CHECK(std::abs(last.ball.x + 0.04) < 0.2 * (std::exp(-23.0) + 1e-7));
  CHECK(std::abs(last.ball.y - 0.01) < 0.2 * (std::exp(-23.0) + 1e-7));
}

TEST_CASE("a run across a jump of the reference equals two runs joined there") {
  const auto method = GENERATE(Method::radau, Method::bdf);
  const double at = 2.125;
  const Pair before{0.01, 0.02}, after{-0.04, 0.01};
  const double rtol = 1e-10, atol = 1e-12;
  Scenario first = follows(PointReference{before});
  first.time = {at, at};
  const Run head = run_in_memory(first, method, {rtol, atol}, false);
  const model::Sample& end = head.samples.back();
  Scenario second = follows(PointReference{after});
  second.ball.position = {end.ball.x, end.ball.y};
  second.ball.velocity = {end.ball.x_dot, end.ball.y_dot};
  second.ball.spin = end.ball.gamma_dot;
  second.gimbal.start = {end.gimbal.phi, end.gimbal.theta, end.gimbal.phi_dot,
                         end.gimbal.theta_dot};
  second.time = {8 - at, 0.125};
  const Run tail = run_in_memory(second, method, {rtol, atol}, false);
  Scenario rows = follows(StaircaseReference{{before, after}, {at}});
  rows.time = {8, 0.125};
  const Run stepped = run_in_memory(rows, method, {rtol, atol}, false);
  // In a stable loop each step leaves at most rtol |z| + atol, with |z| below 0.5. Its effect on
  // the ball is largest for angles: 5 g / 7 over the square of the slowest pole, 3.2 m/rad,
  // below 5.
  const double bound =
      5 * 2 * static_cast<double>(stepped.outcome.statistics.steps) * (rtol * 0.5 + atol);
  CHECK(bound < 1e-5);
  const std::size_t jump = 17;  // the row at 2.125 s
  for (std::size_t i = 0; i < tail.samples.size(); ++i) {
    const model::Sample &a = stepped.samples[jump + i], &b = tail.samples[i];
    CAPTURE(a.t, b.t);
    CHECK(std::abs(a.ball.x - b.ball.x) < bound);
    CHECK(std::abs(a.ball.y - b.ball.y) < bound);
    CHECK(std::abs(a.gimbal.phi - b.gimbal.phi) < bound);
    CHECK(a.reference == after);
  }
  CHECK(stepped.samples[jump - 1].reference == before);
  // At rest on its reference, the ball does not anticipate the jump. The tolerance leaves 5 steps
  // of the loop, as above.
  CHECK(std::abs(stepped.samples[jump].ball.x - before[0]) < bound);
  // The command jumps with the reference: the row at the jump shows the value after it.
  CHECK(std::abs(stepped.samples[jump].command[0] - 0.6 * (after[0] - before[0])) < bound);
  CHECK(std::abs(stepped.samples[jump - 1].command[0]) < bound);
}

TEST_CASE("a sampled law sees a jump of the reference at the next sample") {
  Scenario scene = follows(StaircaseReference{{{0.01, 0.02}, {0.03, 0.02}}, {0.9}});
  scene.controller->sampling = Sampling{0.03, 0};
  scene.time = {1.5, 0.01};
  const double asked = 0.6 * 0.02;  // kp; at rest a difference of positions is zero
  const auto command_at = [&](double at, double t) {
    std::get<StaircaseReference>(scene.controller->reference).jumps = {at};
    const Run run = run_in_memory(scene, Method::radau, {1e-9, 1e-11});
    return run.samples[static_cast<std::size_t>(std::lround(t / 0.01))].command[0];
  };
  // 30 * 30 ms rounds to just below 0.9 s; still, this sample is the first to see the jump.
  CHECK(30 * 0.03 < 0.9);
  CHECK(command_at(0.9, 0.89) == 0);
  CHECK(std::abs(command_at(0.9, 0.9) - asked) < 1e-15);
  CHECK(std::abs(command_at(0.88, 0.9) - asked) < 1e-15);
  CHECK(command_at(0.88, 0.89) == 0);
  CHECK(command_at(0.901, 0.92) == 0);
  CHECK(std::abs(command_at(0.901, 0.93) - asked) < 1e-15);
}

}  // namespace bbsim_test::test_reference_paths
