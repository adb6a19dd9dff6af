// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Closed loops along each kind of reference path: two integrators agree, and the ball follows.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "support/run_in_memory.hpp"

using namespace bbsim;
using namespace bbsim_test;

namespace {

struct Path {
  std::string name;
  Reference reference;
  std::size_t stops;
};

std::vector<Path> paths() {
  const std::vector<Pair> points{{0, 0}, {0.06, 0.02}, {0.03, 0.07}, {-0.04, 0.01}};
  const std::vector<double> times{0.5, 2, 3.5, 6};
  TableReference table{"path.csv", {}, {}, {}};
  for (int i = 0; i <= 16; ++i) {
    const double t = 0.5 * i;
    table.times.push_back(t);
    table.x.push_back(0.05 * std::sin(0.8 * t));
    table.y.push_back(0.004 * t);
  }
  return {{"circle", CircleReference{0.03, 0.8, 0, {0.02, -0.01}}, 0},
          {"lissajous", LissajousReference{{0.05, 0.03}, {0.5, 1}, {1.2, 0}, {0.01, 0}}, 0},
          {"waypoints", WaypointReference{points, times, false}, 4},
          {"waypoints at rest", WaypointReference{points, times, true}, 4},
          {"table", table, 15}};
}

// Poles about home by (M13), 1/s: -22.4 +- 14.6i of the servo, -3.84 and -1.48.
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

TEST_CASE("radau and BDF agree along every reference path") {
  const auto index = GENERATE(range(0, 5));
  const Path path = paths()[static_cast<std::size_t>(index)];
  CAPTURE(path.name);
  const Scenario scene = follows(path.reference);
  CHECK(model::assemble(scene, false).stops.size() == path.stops);

  const double rtol = 1e-10, atol = 1e-12;
  const Run ours = run_in_memory(scene, Method::radau, {rtol, atol});
  const Run theirs = run_in_memory(scene, Method::bdf, {rtol, atol});
  REQUIRE(ours.outcome.ending == solve::Ending::done);
  REQUIRE(theirs.outcome.ending == solve::Ending::done);
  REQUIRE(ours.samples.size() == theirs.samples.size());

  double largest = 0;  // of any state that the tolerance is relative to
  for (const model::Sample& sample : theirs.samples) {
    largest = std::max({largest, std::abs(sample.ball.x), std::abs(sample.ball.y),
                        std::abs(sample.ball.x_dot), std::abs(sample.ball.y_dot),
                        std::abs(sample.gimbal.phi), std::abs(sample.gimbal.theta),
                        std::abs(sample.gimbal.phi_dot), std::abs(sample.gimbal.theta_dot)});
  }
  // The loop is stable, so that each step leaves no more than its local error, rtol |z| + atol, in
  // each of the nine states. What it moves the ball by in the end is largest for the angles: 5 g /
  // 7 over the square of the slowest pole, 3.2 m/rad, rounded up to 5.
  const double steps =
      static_cast<double>(ours.outcome.statistics.steps + theirs.outcome.statistics.steps);
  const double bound = 5 * steps * (rtol * largest + atol);
  CHECK(bound < 1e-5);  // else the comparison would say little
  const model::SignalPair* reference = nullptr;
  const model::Model model = model::assemble(scene, false);
  std::visit(
      [&](const auto& system) {
        if constexpr (!std::decay_t<decltype(system)>::open_loop) reference = &system.reference();
      },
      model.system);
  REQUIRE(reference != nullptr);
  for (std::size_t i = 0; i < ours.samples.size(); ++i) {
    const model::Sample &a = ours.samples[i], &b = theirs.samples[i];
    CAPTURE(a.t);
    CHECK(std::abs(a.ball.x - b.ball.x) < bound);
    CHECK(std::abs(a.ball.y - b.ball.y) < bound);
    // The columns show the path itself.
    CHECK(a.reference[0] == reference->at(a.t)[0].value);
    CHECK(a.reference[1] == reference->at(a.t)[1].value);
  }
}

TEST_CASE("the ball comes to rest where the waypoints end") {
  const bool rest = GENERATE(false, true);
  const std::vector<Pair> points{{0, 0}, {0.06, 0.02}, {-0.04, 0.01}};
  Scenario scene = follows(WaypointReference{points, {0, 2, 4}, rest});
  scene.time = {20, 0.5};
  const Run run = run_in_memory(scene, Method::radau, {1e-8, 1e-10});
  const model::Sample& last = run.samples.back();
  CHECK(last.reference == Pair{-0.04, 0.01});
  // After 16 s the slowest pole has left e^-23.7 of what was there at 4 s, at most 0.2 m. A
  // local error, rtol of 0.2 m, is what the integration itself may leave, ten times over.
  CHECK(std::abs(last.ball.x + 0.04) < 0.2 * (std::exp(-23.0) + 1e-7));
  CHECK(std::abs(last.ball.y - 0.01) < 0.2 * (std::exp(-23.0) + 1e-7));
}
