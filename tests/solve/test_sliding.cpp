// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// From sliding to rolling and back, against closed forms: docs/explanation/losses-and-torques.md.
#include <cmath>

#include "catch.hpp"
#include "model/ball/dynamics.hpp"
#include "support/energy_balance.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_sliding {

using namespace bbsim;

namespace {

constexpr solve::Tolerances tight{1e-11, 1e-13};
constexpr double g = 9.81;

Scenario level(double static_friction, double sliding) {
  Scenario scene;
  scene.gravity = g;
  scene.ball.radius = 0.02;
  scene.ball.mass = 0.05;
  scene.gimbal.motion = GimbalMotion{};
  scene.events.slip = SlipEvent{static_friction, OnEvent::note, sliding};
  scene.time = {2, 0.02};
  return scene;
}

double time_of(const Run& run, const std::string& name) {
  for (const model::Occurrence& event : run.outcome.occurrences) {
    if (event.name == name) return event.t;
  }
  return std::nan("");
}

}  // namespace

TEST_CASE("a ball that starts without rotation slides, and rolls once friction has turned it") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  const double k = GENERATE(0.4, 2.0 / 3);
  CAPTURE(static_cast<int>(method), k);
  Scenario scene = level(0.3, 0.25);
  scene.ball.inertia_factor = k;
  scene.ball.velocity = {0.6, 0.8};  // 1 m/s
  scene.ball.rotation = Pair{0, 0};
  const Run run = run_in_memory(scene, method, tight);
  const double a = 0.25 * g, rolls = k / ((1 + k) * a);
  CHECK(std::abs(time_of(run, "roll") - rolls) < 1e-10);
  for (const model::Sample& s : run.samples) {
    const double t = std::min(s.t, rolls);
    const double way = t - a * t * t / 2 + (s.t - t) / (1 + k);
    const double speed = 1 - a * t;
    CAPTURE(s.t);
    CHECK(std::abs(s.ball.x - 0.6 * way) < 1e-11);
    CHECK(std::abs(s.ball.y - 0.8 * way) < 1e-11);
    CHECK(std::abs(s.ball.x_dot - 0.6 * speed) < 1e-11);
    // The remaining slip.
    const double slip = std::max(0.0, 1 - a * (1 + 1 / k) * s.t);
    CHECK(std::abs(std::hypot(s.coupled->slip[0], s.coupled->slip[1]) - slip) < 1e-10);
    if (s.t > rolls) CHECK(s.coupled->slip[0] == 0);
  }
  CHECK(std::abs(run.samples.back().ball.x_dot - 0.6 / (1 + k)) < 1e-12);
  CHECK(energy_gap(scene, run) < 1e-11);
}

TEST_CASE("backspin brings a ball back") {
  const double backspin = GENERATE(-30.0, -200.0, 90.0);
  Scenario scene = level(0.3, 0.2);
  scene.ball.velocity = {1, 0};
  scene.ball.rotation = Pair{0, backspin};
  const Run run = run_in_memory(scene, Method::radau, tight);
  const double k = 0.4, last = (1 + k * 0.02 * backspin) / (1 + k);
  CAPTURE(backspin);
  CHECK(std::abs(run.samples.back().ball.x_dot - last) < 1e-12);
  CHECK(run.samples.back().ball.y == 0);
  CHECK(energy_gap(scene, run) < 1e-11);
}

TEST_CASE("a ball that starts with rolling's own rotation never slides") {
  Scenario scene = level(0.3, 0.2);
  scene.ball.velocity = {0.5, -0.25};
  scene.ball.rotation = Pair{0.25 / 0.02, 0.5 / 0.02};
  const Run run = run_in_memory(scene, Method::radau, tight);
  CHECK(run.samples.back().ball.x == Approx(1).epsilon(1e-14));
  CHECK(run.samples.back().coupled->lost == 0);
}

TEST_CASE("a ball slides down an incline too steep for its friction") {
  // Rolling needs a friction force of k/(1 + k) tan(tilt) of the normal force: 2/7 of it.
  const double limit = 2.0 / 7 * std::tan(0.9);
  for (const double beyond : {-1e-12, 1e-12}) {
    Scenario scene = level(limit * (1 - beyond), 0.2);
    scene.gimbal.motion->phi = {0.9};
    scene.time = {1, 0.1};
    const Run run = run_in_memory(scene, Method::radau, tight);
    CAPTURE(beyond);
    const double rolling = 5.0 / 7 * g * std::sin(0.9);
    const double sliding = g * (std::sin(0.9) - 0.2 * std::cos(0.9));
    CHECK(std::abs(run.samples.back().ball.x_dot - (beyond < 0 ? rolling : sliding)) < 1e-11);
    CHECK(energy_gap(scene, run) < 1e-11);
  }
}

TEST_CASE(
    "on a plate that tilts slowly a ball slides once rolling needs more than static friction") {
  const Method method = GENERATE(Method::radau, Method::bdf);
  const double sign = GENERATE(1.0, -1.0);
  Scenario scene = level(0.01, 0.008);
  scene.gimbal.motion->phi = {Ramp{0, sign * 1e-3}};
  scene.time = {40, 1};
  const Run run = run_in_memory(scene, method, tight);
  // Of g, 2 x' phi' takes phi^2 / 1.4 from the normal force, and x phi'^2 adds a sixth of that
  // downhill.
  const double phi = std::atan(3.5 * 0.01);
  CHECK(time_of(run, "slip") == Approx(phi * (1 - phi * phi * 5 / 6) / 1e-3).epsilon(1e-5));
}

TEST_CASE("rolling that needs exactly the available friction") {
  // The demand touches the limit at the top of each swing: the ball may slide for an instant, and
  // then rolls on as before.
  Scenario scene = level(0.3, 0.3);
  scene.gimbal.motion->phi = {Sinusoid{0.1, 4, 0, 0}};
  scene.time = {1.5, 0.01};
  const Run ideal = run_in_memory(
      [&] {
        Scenario without = scene;
        without.events.slip.reset();
        return without;
      }(),
      Method::radau, tight);
  double most = 0;
  for (const model::Sample& s : ideal.samples) {
    const model::Dynamics now = model::dynamics(s, model::constants_of(scene));
    most = std::max(most, now.friction_force() / now.normal_force());
  }
  for (const double part : {1 - 1e-6, 1 + 1e-3}) {
    scene.events.slip->friction = scene.events.slip->sliding.emplace() = most * part;
    const Run run = run_in_memory(scene, Method::radau, tight);
    CAPTURE(part);
    CHECK(run.outcome.ending == solve::Ending::done);
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      CHECK(std::abs(run.samples[i].ball.x - ideal.samples[i].ball.x) < 1e-5);
    }
    CHECK(energy_gap(scene, run) < 1e-10);
  }
}

TEST_CASE("sliding changes to rolling at the tightest tolerances") {
  const std::string name = GENERATE("slides-late-steep", "slides-late-slow");
  Scenario scene = scenario_named(name);
  CAPTURE(name);
  const Run run = run_in_memory(scene, Method::radau, {scene.solver.rtol, scene.solver.atol});
  CHECK(run.outcome.ending != solve::Ending::failed);
  CHECK(run.outcome.statistics.steps < 2000);
  // The same motion at an ordinary tolerance agrees within that tolerance.
  const Run plain = run_in_memory(scene, Method::radau, {1e-9, 1e-11});
  REQUIRE(plain.samples.size() == run.samples.size());
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    CHECK(std::abs(run.samples[i].ball.x - plain.samples[i].ball.x) < 1e-7);
    CHECK(std::abs(run.samples[i].ball.y - plain.samples[i].ball.y) < 1e-7);
  }
}

TEST_CASE("the friction demand of a sliding ball is its coefficient, until it lifts off") {
  const Scenario scene = scenario_named("lifts-off-sliding");
  const Run run = run_in_memory(scene, Method::radau, {1e-12, 1e-13});
  REQUIRE(run.outcome.ending == solve::Ending::stopped);
  const model::Sample& end = run.outcome.occurrences.back().sample;
  const model::Dynamics now = model::dynamics(end, model::constants_of(scene));
  CHECK(std::abs(now.normal_force()) < 1e-12);
  CHECK(now.friction_demand() == scene.events.slip->sliding);
}

TEST_CASE("slipping and lift-off do not depend on the ball's mass") {
  const auto events = [](double mass) {
    Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/slips.yaml");
    scene.ball.mass = mass;
    return run_in_memory(scene, Method::radau, tight).outcome;
  };
  const solve::Outcome plain = events(1);
  REQUIRE(plain.occurrences.size() >= 2);
  for (const double mass : {1e-14, 1e9}) {
    const solve::Outcome other = events(mass);
    REQUIRE(other.occurrences.size() == plain.occurrences.size());
    for (std::size_t i = 0; i < plain.occurrences.size(); ++i) {
      CHECK(other.occurrences[i].name == plain.occurrences[i].name);
      CHECK(std::abs(other.occurrences[i].t - plain.occurrences[i].t) < 1e-10);
    }
  }
}

}  // namespace bbsim_test::test_sliding
