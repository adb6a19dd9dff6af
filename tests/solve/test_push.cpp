// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A force on the ball's center.
#include <cmath>

#include "catch.hpp"
#include "model/ball/dynamics.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_push {

using namespace bbsim;

namespace {

Scenario level() {
  Scenario scene;
  scene.gravity = 9.81;
  scene.ball.radius = 0.02;
  scene.ball.mass = 0.05;
  scene.gimbal.motion.emplace();
  scene.time = {2, 0.1};
  return scene;
}

Run run_of(const Scenario& scene, Method method = Method::automatic) {
  return whole_run(scene, method, {1e-11, 1e-13});
}

// Difference of the work of push and motors, from Simpson's rule, and the energy gained.
double work_gap(const Scenario& scene, const Run& run) {
  const model::BallConstants constants = model::constants_of(scene);
  double work = 0, gap = 0, size = 0, first = 0;
  std::vector<double> power;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    const model::Dynamics now = model::dynamics(run.samples[i], constants);
    power.push_back(now.push_power);
    const double energy = now.energy() + now.gimbal_energy + now.coupled.lost - now.coupled.work;
    if (i == 0) first = energy;
    if (i >= 2 && i % 2 == 0) {
      work += scene.time.step / 3 * (power[i - 2] + 4 * power[i - 1] + power[i]);
      gap = std::max(gap, std::abs(energy - first - work));
      size = std::max(size, std::abs(energy - first));
    }
  }
  return gap / size;
}

}  // namespace

TEST_CASE(
    "on a level plate a push gives P / ((1 + k) m); friction opposes with k / (1 + k) of it") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  Scenario scene = level();
  scene.ball.push = BallPush{{0.01}, {Sinusoid{0.02, 3, 0, 0}}};
  const Run run = run_of(scene, method);
  const double m = scene.ball.mass, k = 0.4;
  for (const model::Sample& now : run.samples) {
    const double t = now.t;
    CHECK(std::abs(now.ball.x - 0.01 / (1 + k) / m * t * t / 2) < 1e-9);
    // y'' = a sin 3t from rest.
    const double a = 0.02 / (1 + k) / m;
    CHECK(std::abs(now.ball.y - a * (t / 3 - std::sin(3 * t) / 9)) < 1e-9);
    const model::Dynamics of = model::dynamics(now, model::constants_of(scene));
    CHECK(std::abs(of.force[0] - (m * 0.01 / (1 + k) / m - 0.01)) < 1e-12);
    CHECK(of.normal_force() == Approx(m * 9.81).epsilon(1e-12));
  }
}

TEST_CASE("the energy that a push gives is its power, whatever moves the gimbal") {
  Scenario scene = level();
  scene.time = {3, 0.002};
  SECTION("a given motion") {
    scene.gimbal.motion = {{Sinusoid{0.1, 2, 0, 0}}, {Sinusoid{0.05, 3, 1, 0}}};
  }
  SECTION("losses") {
    scene.ball.losses.rolling = 0.003;
    scene.ball.velocity = {0.3, 0.2};
  }
  SECTION("torques") {
    scene.gimbal.motion.reset();
    scene.gimbal.torque = {{Sinusoid{0.01, 3, 0, 0}}, {}};
    scene.plate = {{}, {}, std::array{4e-3, 6e-3, 1e-2}, 0.3, -0.05};
  }
  scene.ball.push = BallPush{{Sinusoid{0.03, 2, 0.3, 0}}, {Ramp{0.01, -0.005}}};
  // Simpson's rule over 2 ms: h^4 times fourth derivatives of some tens.
  CHECK(work_gap(scene, run_of(scene)) < 1e-8);
}

TEST_CASE("a push moves a ball held by rolling resistance once it exceeds c_rr N") {
  Scenario scene = level();
  scene.ball.losses.rolling = 0.01;
  scene.ball.push = BallPush{{Ramp{0, 0.01}}, {}};
  scene.time = {1, 0.01};
  const Run run = run_of(scene);
  // Rest needs a couple of P r.
  const double starts = 0.01 * 0.05 * 9.81 / 0.01;
  for (const model::Sample& now : run.samples) {
    if (now.t < starts) CHECK(now.ball.x == 0);
    if (now.t < starts) continue;
    const double t = now.t - starts;
    CHECK(std::abs(now.ball.x - 0.01 / (1.4 * 0.05) * t * t * t / 6) < 1e-9);
  }
}

}  // namespace bbsim_test::test_push
