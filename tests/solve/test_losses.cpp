// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Dry and viscous losses of a ball against closed forms:
// docs/explanation/losses-and-torques.md.
#include <cmath>

#include "catch.hpp"
#include "support/energy_balance.hpp"
#include "support/largest.hpp"
#include "support/reading.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_losses {

using namespace bbsim;

namespace {

constexpr solve::Tolerances tight{1e-11, 1e-13};

// A ball on a stationary plate.
Scenario at_rest(double rolling, double viscous, double pivoting) {
  Scenario scene;
  scene.gravity = 9.81;
  scene.ball.radius = 0.02;
  scene.ball.mass = 0.05;
  scene.ball.losses = {rolling, viscous, pivoting};
  scene.gimbal.motion = GimbalMotion{};
  scene.time = {20, 0.5};
  return scene;
}

std::size_t count(const Run& run, const std::string& name) {
  std::size_t found = 0;
  for (const model::Occurrence& event : run.outcome.occurrences)
    found += event.name == name ? 1 : 0;
  return found;
}

}  // namespace

TEST_CASE("a ball coasts to rest on a level plate and stays") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  const double factor = GENERATE(0.4, 2.0 / 3, 0.0);
  CAPTURE(static_cast<int>(method), factor);
  Scenario scene = at_rest(0.004, 0, 0);
  scene.ball.inertia_factor = factor;
  scene.ball.position = {0.01, -0.02};
  scene.ball.velocity = {0.12, -0.16};  // 0.2 m/s
  scene.events.rest = OnEvent::note;
  const Run run = run_in_memory(scene, method, tight);
  const double a = 0.004 * 9.81 / (1 + factor), stop = 0.2 / a;
  for (const model::Sample& s : run.samples) {
    const double t = std::min(s.t, stop), way = 0.2 * t - a * t * t / 2;
    CAPTURE(s.t);
    // 100 times the absolute tolerance over 20 s.
    CHECK(std::abs(s.ball.x - (0.01 + 0.6 * way)) < 1e-11);
    CHECK(std::abs(s.ball.y - (-0.02 - 0.8 * way)) < 1e-11);
    if (s.t > stop) {
      CHECK(s.ball.x_dot == 0);
      CHECK(s.ball.y_dot == 0);
      CHECK(s.ball.x == run.samples.back().ball.x);
    }
  }
  REQUIRE(count(run, "rest") == 1);
  CHECK(std::abs(run.outcome.occurrences.front().t - stop) < 1e-10);
  CHECK(energy_gap(scene, run) < 1e-11);
}

TEST_CASE("an incline moves a ball once the tangent of its tilt exceeds the coefficient") {
  const double c = 0.003;
  for (const double beyond : {-1e-12, 1e-12, 0.5}) {
    Scenario scene = at_rest(c, 0, 0);
    const double tilt = std::atan(c * (1 + beyond));
    scene.gimbal.motion->theta = {tilt};  // +y rises
    const Run run = run_in_memory(scene, Method::radau, tight);
    CAPTURE(beyond);
    const double end = scene.time.end;
    const double a = 9.81 * (std::sin(tilt) - c * std::cos(tilt)) / 1.4;
    if (beyond < 0) {
      CHECK(run.samples.back().ball.y == 0);
      CHECK(run.outcome.statistics.steps == 1);
    } else {
      CHECK(run.samples.back().ball.y < 0);
      CHECK(std::abs(run.samples.back().ball.y + a * end * end / 2) < 1e-11);
      CHECK(std::abs(run.samples.back().ball.y_dot + a * end) < 1e-12);
    }
    CHECK(run.samples.back().ball.x == 0);
  }
}

TEST_CASE("a ball sticks to a slowly tilting plate and breaks away") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  CAPTURE(static_cast<int>(method));
  const double c = 0.005, w = 0.001;
  Scenario scene = at_rest(c, 0, 1e-4);
  scene.gimbal.motion->phi = {Ramp{0, w}};
  scene.time = {10, 0.01};
  const Run run = run_in_memory(scene, method, tight);
  // Required is g sin phi, available c (g cos phi - r w^2): the plane turns at a constant rate.
  const double r = scene.ball.radius, g = scene.gravity;
  const double lets_go = (std::atan(c) - std::asin(c * r * w * w / (g * std::sqrt(1 + c * c)))) / w;
  REQUIRE(lets_go > 4.9);
  REQUIRE(lets_go < 5.1);
  for (const model::Sample& s : run.samples) {
    CAPTURE(s.t);
    if (s.t < lets_go) {
      CHECK(s.ball.x == 0);
    } else {
      // x'' grows from zero by g w cos phi / (1 + k) per second: x = jerk t^3 / 6, up to the
      // effects of phi and c.
      const double t = s.t - lets_go, expected = g * w / 1.4 * t * t * t / 6;
      CHECK(std::abs(s.ball.x - expected) < 1e-2 * expected + 1e-12);
    }
  }
  CHECK(energy_gap(scene, run) < 1e-9);
}

TEST_CASE("pivoting friction stops the spin, and the ball stays") {
  Scenario scene = at_rest(0, 0, 5e-4);
  scene.ball.spin = -30;
  scene.time = {5, 0.1};
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  const Run run = run_in_memory(scene, method, tight);
  const double a = 5e-4 * 9.81 / (0.4 * 0.02 * 0.02), stop = 30 / a;
  REQUIRE(stop < 1);
  for (const model::Sample& s : run.samples) {
    const double t = std::min(s.t, stop);
    CHECK(std::abs(s.ball.gamma_dot + (30 - a * t)) < 1e-9);
    CHECK(std::abs(s.gamma + (30 * t - a * t * t / 2)) < 1e-9);
    if (s.t > stop) CHECK(s.ball.gamma_dot == 0);
  }
  CHECK(energy_gap(scene, run) < 1e-11);
}

TEST_CASE("viscous loss alone makes the velocity decay") {
  Scenario scene = at_rest(0, 3e-6, 0);
  scene.ball.velocity = {0.3, 0.1};
  const Run run = run_in_memory(scene, Method::radau, tight);
  const double rate = 3e-6 / (1.4 * 0.05 * 0.02 * 0.02);
  for (const model::Sample& s : run.samples) {
    CHECK(std::abs(s.ball.x_dot - 0.3 * std::exp(-rate * s.t)) < 1e-11);
    CHECK(std::abs(s.ball.y_dot - 0.1 * std::exp(-rate * s.t)) < 1e-11);
  }
  CHECK(energy_gap(scene, run) < 1e-11);
}

TEST_CASE("a ball at rest stays there bit for bit for 1e5 s, in one step") {
  Scenario scene = at_rest(0.002, 1e-6, 1e-4);
  scene.ball.position = {0.1, -0.3};
  scene.gimbal.motion->phi = {0.001};
  scene.gimbal.motion->theta = {-0.0012};
  scene.time = {1e5, 1e3};
  const Run run = run_in_memory(scene, Method::automatic, {1e-8, 1e-10});
  CHECK(run.outcome.statistics.steps == 1);
  for (const model::Sample& s : run.samples) {
    CHECK(s.ball.x == 0.1);
    CHECK(s.ball.y == -0.3);
    CHECK(s.ball.x_dot == 0);
    CHECK(s.ball.gamma_dot == 0);
    CHECK(s.gamma == 0);
    CHECK(s.coupled->lost == 0);
  }
}

TEST_CASE("rolling resistance that switches thousands of times conserves the energy balance") {
  // A plate that rocks across the friction angle in both axes: the ball starts and stops in each
  // swing.
  Scenario scene = at_rest(0.01, 1e-6, 2e-5);
  scene.ball.spin = 3;
  scene.gimbal.motion->phi = {Sinusoid{0.013, 7, 0.3, 0}};
  scene.gimbal.motion->theta = {Sinusoid{0.004, 7, 0, 0}};
  scene.time = {800, 0.5};
  scene.events.rest = OnEvent::note;
  const Run run = run_in_memory(scene, Method::radau, {1e-10, 1e-12});
  CHECK(run.outcome.ending == solve::Ending::done);
  CHECK(count(run, "rest") > 1000);
  CHECK(energy_gap(scene, run) < 1e-9);
}

TEST_CASE("losses also act under servos and sampled controllers") {
  const std::string servo =
      "gravity: 9.81\n"
      "ball: {radius: 0.02, mass: 0.05, position: [0.05, 0.02], losses: {rolling: 0.002}}\n"
      "time: {end: 6, step: 0.05}\n"
      "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
      "controller: {gravity_compensation: {kp: 9, kv: 2}, drives: angle, reference: {point: [0, "
      "0]}";
  const std::string sampling = GENERATE(", sampling: {period: 0.02}}\n", "}\n");
  CAPTURE(sampling);
  const Scenario scene = test::parse(servo + sampling);
  Scenario ideal = scene;
  ideal.ball.losses = {};
  const Run with = run_in_memory(scene, Method::radau, {1e-10, 1e-12});
  const Run without = run_in_memory(ideal, Method::radau, {1e-10, 1e-12});
  // The ideal ball creeps to its place. The other stops before it, where the tilt is below its
  // coefficient: within c g / ((1 + k) kp).
  CHECK(std::abs(without.samples.back().ball.x) < 1e-3);
  const model::Sample& last = with.samples.back();
  CHECK(last.ball.x_dot == 0);
  CHECK(last.ball.y_dot == 0);
  CHECK(std::hypot(last.ball.x, last.ball.y) > 1e-5);
  CHECK(std::hypot(last.ball.x, last.ball.y) < 1.2 * 0.002 * 9.81 / (1.4 * 9));
  if (sampling == "}\n") CHECK(energy_gap(scene, with) < 1e-9);
}

TEST_CASE("a ball that breaks away feels resistance against its initial acceleration") {
  // The light plate yields to the ball, which starts 23 degrees off the force that held it.
  const Scenario scene = test::parse(
      "ball: {radius: 0.02, mass: 0.5, position: [0.1, 0.06], losses: {rolling: 0.05}}\n"
      "plate: {inertia: [0.001, 0.003, 0.0035]}\n"
      "gimbal: {torque: {phi: 0.45, theta: 0.1}}\n"
      "time: {end: 2e-6, step: 1e-6}\n");
  const Run run = run_in_memory(scene, Method::radau, {1e-12, 1e-13});
  REQUIRE(run.samples.size() == 3);
  const auto accelerations = [&](std::size_t i) {
    return Pair{run.samples[i].gimbal.phi_ddot, run.samples[i].gimbal.theta_ddot};
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double at_start = accelerations(0)[axis], soon = accelerations(1)[axis];
    const double drift = accelerations(2)[axis] - soon;
    // The acceleration changes as t^2: from 0 to 1 us a third as much as from 1 to 2 us.
    CHECK(std::abs(soon - at_start) < std::abs(drift));
  }
}

TEST_CASE("a ball nearly at rest on a plate lighter than itself continues") {
  const Scenario scene = test::parse(
      "ball: {radius: 0.0946502233951858, mass: 3, velocity: [-0.27123241728303826, -0.02],\n"
      "       spin: -24.82340520375807, inertia_factor: 0.6455335337945438,\n"
      "       losses: {rolling: 0.02, viscous: 0.0007835, pivoting: 0.00454813}}\n"
      "plate: {inertia: [0.003541143324578275, 3.393901282063695e-05, 0.01240908294714108]}\n"
      "gimbal:\n"
      "  torque: {phi: 0.003, theta: {sinusoid: {amplitude: -0.026849, frequency: 0.722444,\n"
      "           offset: -0.00305815}}}\n"
      "  ring_inertia: 5.695618936749016e-05\n"
      "time: {end: 0.2, step: 0.001}\n");
  const Method method = GENERATE(Method::radau, Method::bdf);
  const Run run = run_in_memory(scene, method, {1e-10, 1e-12});
  CHECK(run.outcome.ending == solve::Ending::done);
  CHECK(run.outcome.statistics.steps < 5000);
  CHECK(energy_gap(scene, run) < 1e-8);
}

TEST_CASE("a ball that slides without turning is not at rest") {
  // c_rr > mu_k: resistance first stops the turning, and the ball slides on.
  const Scenario scene = test::parse(
      "gravity: 9.81\n"
      "ball: {radius: 0.02, velocity: [0.5, 0], losses: {rolling: 0.05}}\n"
      "gimbal: {motion: {}}\n"
      "events: {slip: {friction: 0.04, sliding_friction: 0.02, action: slide}, rest: note}\n"
      "time: {end: 5, step: 0.1}\n");
  const Run run = run_in_memory(scene, Method::radau, tight);
  REQUIRE(count(run, "rest") == 1);
  for (const model::Occurrence& event : run.outcome.occurrences) {
    if (event.name != "rest") continue;
    CHECK(event.sample.ball.x_dot == 0);
    CHECK(event.sample.ball.y_dot == 0);
  }
}

}  // namespace bbsim_test::test_losses
