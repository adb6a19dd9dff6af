// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What holds for every scene, with every integrator: a table of scenes, and one test a property.
#include <atomic>
#include <cmath>

#include "catch.hpp"
#include "solve/scene_table.hpp"
#include "support/energy_balance.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_every_scene {

using namespace bbsim;

namespace {

constexpr solve::Tolerances usual{1e-10, 1e-12};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// Bit for bit.
bool same(const model::Sample& a, const model::Sample& b) {
  return a.ball.x == b.ball.x && a.ball.y == b.ball.y && a.ball.x_dot == b.ball.x_dot &&
         a.ball.y_dot == b.ball.y_dot && a.ball.gamma_dot == b.ball.gamma_dot &&
         same(a.gamma, b.gamma) && a.gimbal.phi == b.gimbal.phi &&
         a.gimbal.theta == b.gimbal.theta && a.gimbal.phi_dot == b.gimbal.phi_dot &&
         a.gimbal.theta_dot == b.gimbal.theta_dot && same(a.command[0], b.command[0]) &&
         same(a.command[1], b.command[1]) && same(a.measured[0], b.measured[0]) &&
         same(a.measured[1], b.measured[1]);
}

// Largest distance of the ball's place and turn, m, and of a tenth of the plane's angles, rad.
double distance(const Run& a, const Run& b, double radius) {
  REQUIRE(a.samples.size() == b.samples.size());
  double apart = 0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    const model::Sample &p = a.samples[i], &q = b.samples[i];
    apart = largest_finite(
        apart, {std::abs(p.ball.x - q.ball.x), std::abs(p.ball.y - q.ball.y),
                radius * std::abs(p.gamma - q.gamma), std::abs(p.gimbal.phi - q.gimbal.phi) / 10,
                std::abs(p.gimbal.theta - q.gimbal.theta) / 10});
  }
  return apart;
}

void check_same_events(const Run& a, const Run& b, double within) {
  REQUIRE(a.outcome.occurrences.size() == b.outcome.occurrences.size());
  for (std::size_t i = 0; i < a.outcome.occurrences.size(); ++i) {
    const model::Occurrence &p = a.outcome.occurrences[i], &q = b.outcome.occurrences[i];
    CAPTURE(p.name, p.t, q.t);
    CHECK(p.name == q.name);
    CHECK(p.stopped == q.stopped);
    CHECK(std::abs(p.t - q.t) < within);
  }
}

}  // namespace

TEST_CASE("every scene: the integrators agree on its motion, its switches and its events") {
  signgam = 7;  // shared by threads: std::lgamma would write it, and cases of a sweep race on it
  for (const SceneCase& one : scene_cases()) {
    CAPTURE(one.what);
    const Scenario scene = load(one);
    const Run radau = run_in_memory(scene, Method::radau, usual);
    CHECK(radau.outcome.ending != solve::Ending::failed);
    CHECK(radau.outcome.occurrences.size() >= one.events);
    for (const Method method : {Method::bdf, Method::adams}) {
      if (method == Method::adams && one.stiff) continue;
      CAPTURE(int(method));
      const Run other = run_in_memory(scene, method, usual);
      CHECK(other.outcome.ending == radau.outcome.ending);
      CHECK(distance(radau, other, scene.ball.radius) < one.apart);
      check_same_events(radau, other, 1e3 * one.apart);
    }
    const Run loose = run_in_memory(scene, Method::radau, {1e-7, 1e-9});
    CHECK(distance(radau, loose, scene.ball.radius) < 1e3 * one.apart);
    CHECK(loose.outcome.statistics.steps <= radau.outcome.statistics.steps);
    for (const model::Sample& sample : radau.samples) {
      if (!scene.controller || !scene.controller->limit) continue;
      for (const double command : sample.command) {
        CHECK(std::abs(command) <= *scene.controller->limit * (1 + 1e-9));
      }
    }
  }
  CHECK(signgam == 7);
}

TEST_CASE("every scene: rows, noted events, an interrupt or a later end change no bit of it") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  for (const SceneCase& one : scene_cases()) {
    if (method == Method::adams && one.stiff) continue;
    CAPTURE(one.what, int(method));
    const Scenario scene = load(one);
    const Run whole = run_in_memory(scene, method, usual);

    Scenario finer = scene;
    finer.time.step /= 4;
    const Run fine = run_in_memory(finer, method, usual);
    CHECK(fine.outcome.statistics.steps == whole.outcome.statistics.steps);
    for (std::size_t i = 0; i < whole.samples.size(); ++i) {
      const std::size_t at =
          std::min(4 * i, fine.samples.size() - 1);  // the end may be no multiple
      REQUIRE(fine.samples[at].t == whole.samples[i].t);
      REQUIRE(same(fine.samples[at], whole.samples[i]));
    }

    const std::atomic<bool> stop{true};
    const Run part = run_in_memory(scene, method, usual, true, {&stop, {}, {}});
    CHECK(part.outcome.ending == solve::Ending::interrupted);
    CHECK(part.outcome.rows == part.samples.size());
    REQUIRE(part.samples.size() < whole.samples.size());
    for (std::size_t i = 0; i < part.samples.size(); ++i) {
      REQUIRE(same(part.samples[i], whole.samples[i]));
    }

    Scenario watched = scene;
    if (!scene.events.edge) {
      watched.plate.size = Pair{0.05, 0.05};
      watched.events.edge = OnEvent::note;
    }
    if (!scene.events.tilt) watched.events.tilt = TiltEvent{0.03, OnEvent::note};
    const Run noted = run_in_memory(watched, method, usual);
    CHECK(noted.outcome.statistics.steps == whole.outcome.statistics.steps);
    REQUIRE(noted.samples.size() == whole.samples.size());
    // A row at a knot comes from either side of it.
    const double rounding = model::assemble(scene, false).stops.empty() ? 0 : 1e-15;
    for (std::size_t i = 0; i < whole.samples.size(); ++i) {
      REQUIRE(std::abs(noted.samples[i].ball.x - whole.samples[i].ball.x) <= rounding);
      REQUIRE(std::abs(noted.samples[i].ball.y - whole.samples[i].ball.y) <= rounding);
      REQUIRE(std::abs(noted.samples[i].gamma - whole.samples[i].gamma) <= rounding);
    }

    // A sampled run does not look ahead. CVODE reaches its end by a step of its own.
    if (!scene.controller || !scene.controller->sampling) continue;
    Scenario sooner = scene;
    sooner.time.end = whole.samples[whole.samples.size() / 2].t;
    const Run begun = run_in_memory(sooner, method, usual);
    const std::size_t rows = begun.samples.size() - (method == Method::radau ? 0 : 1);
    for (std::size_t i = 0; i < rows; ++i) {
      REQUIRE(same(begun.samples[i], whole.samples[i]));
    }
  }
}

TEST_CASE("every scene: the general equations give the same motion, whose energy balances") {
  for (const SceneCase& one : scene_cases()) {
    CAPTURE(one.what);
    Scenario scene = load(one);
    const Run plain = run_in_memory(scene, Method::radau, usual);
    scene.ball.push = BallPush{{0.0}, {}};
    const Run pushed = run_in_memory(scene, Method::radau, usual);
    CHECK(distance(plain, pushed, scene.ball.radius) < one.apart);
    CHECK(energy_gap(scene, pushed) < 1e-11);
  }
}

}  // namespace bbsim_test::test_every_scene
