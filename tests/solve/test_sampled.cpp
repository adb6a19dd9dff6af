// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Controllers in discrete time: their results and their timing.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_sampled {

using namespace bbsim;

namespace {

Scenario rig() {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.gimbal.servo = Servo{30, 0.8};
  scene.gimbal.servo->rate_limit = 3;
  scene.controller->law = Law::gravity_compensation;
  scene.controller->kp = {{{4, 0}, {0, 4}}};
  scene.controller->kv = {{{4, 0}, {0, 4}}};
  scene.controller->limit = 0.2;
  scene.controller->sampling = Sampling{0.02, 0.01, 0.002, 0.03};
  Sensor sensor;
  sensor.resolution = 3e-4;
  sensor.noise = 2e-4;
  sensor.delay = 0.01;
  sensor.dropout = 0.05;
  scene.controller->sensor = sensor;
  scene.time = {6, 0.1};
  return scene;
}

Run run_of(const Scenario& scene, Method method = Method::automatic) {
  return whole_run(scene, method, {1e-9, 1e-11});
}

bool same(const model::Sample& a, const model::Sample& b) {
  return a.ball.x == b.ball.x && a.ball.y == b.ball.y && a.ball.x_dot == b.ball.x_dot &&
         a.ball.gamma_dot == b.ball.gamma_dot && a.gamma == b.gamma &&
         a.gimbal.phi == b.gimbal.phi && a.gimbal.theta_dot == b.gimbal.theta_dot &&
         a.command == b.command && a.measured == b.measured;
}

}  // namespace

TEST_CASE("the command is held between samples and arrives its delay after them") {
  Scenario scene = rig();
  scene.time = {0.2, 0.001};
  const Run run = run_of(scene);
  double before = run.samples.front().command[0];
  for (const model::Sample& sample : run.samples) {
    const double since = std::fmod(sample.t - 0.01 + 1e-9, 0.02);
    if (sample.command[0] != before) CHECK(std::abs(since) < 1.1e-3);
    before = sample.command[0];
    // In units of the command's resolution.
    const double steps = sample.command[0] / 0.002;
    CHECK(std::abs(steps - std::round(steps)) < 1e-9);
  }
  // Before the first command arrives, the servos have none.
  CHECK(run.samples[5].command == Pair{0, 0});
}

TEST_CASE("a limit that is not a multiple of the command's resolution holds") {
  Scenario scene = rig();
  scene.controller->limit = 0.005;
  scene.controller->sampling->resolution = 0.002;
  double most = 0;
  for (const model::Sample& sample : run_of(scene).samples) {
    most = std::max(most, std::abs(sample.command[0]));
  }
  CHECK(most == 0.004);
}

TEST_CASE("a fast sampled PD tends to the continuous one") {
  // The difference quotient lags half a period, the hold another half: the distance is first order
  // in the period.
  Scenario continuous = fig2b();
  continuous.ball.radius = 0.02;
  continuous.ball.velocity = {0, -0.015};  // the reference's velocity: no initial kick
  continuous.gimbal.servo = Servo{30, 0.8};
  continuous.controller->kp = {{{0.4, 0}, {0, -0.4}}};
  continuous.controller->kv = {{{0.4, 0}, {0, -0.4}}};
  continuous.time = {3, 0.1};
  const Run exact = run_of(continuous);
  const auto distance = [&](double period) {
    Scenario scene = continuous;
    scene.controller->sampling = Sampling{period, 0, 0, 0};
    const Run run = run_of(scene);
    double largest = 0;
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      largest = std::max(largest, std::hypot(run.samples[i].ball.x - exact.samples[i].ball.x,
                                             run.samples[i].ball.y - exact.samples[i].ball.y));
    }
    return largest;
  };
  const double slow = distance(4e-3), fast = distance(1e-3);
  CHECK(fast < 1e-3);
  CHECK(fast < slow / 3);  // first order would give 4
}

TEST_CASE("PID with a limited command does not wind up") {
  // The ball starts far away; the integral waits while the command is at its limit.
  const bool sampled = GENERATE(false, true);
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.ball.position = {0.3, 0};
  scene.gimbal.servo = Servo{30, 0.8};
  scene.gimbal.mounting.phi_offset = 0.02;  // the offset that the integral must remove
  scene.controller->law = Law::pid;
  scene.controller->kp = {{{0.6, 0}, {0, -0.6}}};
  scene.controller->kv = {{{0.5, 0}, {0, -0.5}}};
  scene.controller->ki = {{{0.3, 0}, {0, -0.3}}};
  scene.controller->limit = 0.1;
  scene.controller->reference = PointReference{};
  if (sampled) scene.controller->sampling = Sampling{0.01, 0, 0, 0.02};
  scene.time = {25, 0.05};
  const Run run = run_of(scene);
  double furthest = 0;
  for (const model::Sample& sample : run.samples) {
    CHECK(std::abs(sample.command[0]) <= 0.1 * (1 + 1e-9));
    furthest = std::min(furthest, sample.ball.x);
  }
  // The integral has removed the offset.
  CHECK(std::abs(run.samples.back().ball.x) < 1e-3);
  CHECK(std::abs(run.samples.back().gimbal.phi) < 1e-3);
  // The overshoot stays well below the initial distance.
  CHECK(furthest > -0.15);
}

TEST_CASE("gravity compensation and feedback linearisation follow a circle") {
  Scenario scene = fig2b();
  scene.controller->law = Law::gravity_compensation;
  scene.controller->kp = {{{4, 0}, {0, 4}}};
  scene.controller->kv = {{{4, 0}, {0, 4}}};
  scene.gimbal.servo = Servo{60, 1};
  const auto error_of = [](const Run& run, double after) {
    double largest = 0;
    for (const model::Sample& s : run.samples) {
      if (s.t < after) continue;
      largest = std::max(largest, std::hypot(s.ball.x - s.reference[0], s.ball.y - s.reference[1]));
    }
    return largest;
  };
  CHECK(error_of(run_of(scene), 10) < 1e-3);

  // Exactly, as long as the tilt, the unstable internal state, stays small.
  scene.controller->law = Law::feedback_linearisation;
  scene.controller->drives = Drives::acceleration;
  scene.gimbal.servo.reset();
  scene.ball.velocity = {0, -0.015};
  scene.time = {0.2, 0.01};
  const Run run = run_in_memory(scene, Method::automatic, {1e-10, 1e-12});
  CHECK(run.outcome.ending == solve::Ending::done);
  CHECK(error_of(run, 0) < 1e-9);
  // Later the plane turns over, and the run stops there.
  scene.time = {10, 0.01};
  const Run on = run_in_memory(scene, Method::automatic, {1e-10, 1e-12});
  CHECK(on.outcome.ending == solve::Ending::stopped);
  REQUIRE(on.outcome.occurrences.size() == 1);
  CHECK(on.outcome.occurrences.front().name == "tilt");
  CHECK(error_of(on, 0) < 1e-6);
}

TEST_CASE("feedback linearization stops before its singularity") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  Scenario scene = fig2b();
  scene.controller->law = Law::feedback_linearisation;
  scene.controller->drives = Drives::acceleration;
  scene.controller->kp = scene.controller->kv = {};
  scene.gimbal.servo.reset();
  // At y = 20 r the determinant is zero at theta = -4 degrees: (28), (29).
  const double r = scene.ball.radius, y = 20 * r;
  scene.controller->reference = PointReference{{0, y}};
  scene.ball.position = {0, y};
  scene.gimbal.start.theta = -0.05;
  scene.gimbal.start.theta_rate = -0.5;
  scene.events.singularity = SingularityEvent{0.05, OnEvent::stop};
  scene.time = {1, 0.001};
  const Run run = run_in_memory(scene, method, {1e-10, 1e-12});
  REQUIRE(run.outcome.ending == solve::Ending::stopped);
  REQUIRE(run.outcome.occurrences.size() == 1);
  const model::Occurrence& event = run.outcome.occurrences.front();
  CHECK(event.name == "singularity");
  const double theta = event.sample.gimbal.theta, there = event.sample.ball.y;
  CHECK((7 * r * std::cos(theta) + 5 * there * std::sin(theta)) / (7 * r) ==
        Approx(0.05).epsilon(1e-6));
}

TEST_CASE("dropouts do not change the noise of the remaining samples") {
  Scenario scene = rig();
  scene.controller->sensor->dropout = 0;
  const Run without = run_of(scene);
  scene.controller->sensor->dropout = 1e-12;  // none, in 300 samples
  const Run with = run_of(scene);
  for (std::size_t i = 0; i < with.samples.size(); ++i)
    CHECK(same(with.samples[i], without.samples[i]));
}

}  // namespace bbsim_test::test_sampled
