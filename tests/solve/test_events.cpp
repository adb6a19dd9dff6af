// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Monitored events: every integrator finds them when they happen.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "study/reference.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_events {

using namespace bbsim;

namespace {

struct Case {
  std::string name;
  Scenario scene;
};

double margin(const model::EventMonitors& watched, std::size_t monitor,
              const model::Sample& sample) {
  std::vector<double> values(watched.monitors.size());
  watched.margins(sample, values.data());
  return values[monitor];
}

// The ball rolls off the plate.
Case edge() {
  Scenario scene = fig2a();
  scene.gimbal.motion = {{0.05, Sinusoid{0.02, 2, 0, 0}}, {Sinusoid{0.03, 1.5, 1, 0}}};
  scene.plate.size = Pair{0.3, 0.4};
  scene.events.edge = OnEvent::stop;
  scene.time = {3, 0.1};
  return {"edge", scene};
}

// A rocking plane demands more friction than is available.
Case slip() {
  Scenario scene = fig2a();
  scene.ball.position = {0.1, 0.05};
  scene.gimbal.motion = {{Sinusoid{0.2, 3, 0, 0}}, {Sinusoid{0.15, 4, 0, 0}}};
  scene.events.slip = SlipEvent{0.06, OnEvent::stop};
  scene.time = {3, 0.1};
  return {"slip", scene};
}

// A plane that jerks down under the ball.
Case lift_off() {
  Scenario scene = fig2a();
  scene.ball.position = {0.25, 0};
  scene.gimbal.motion = {{Sinusoid{0.3, 14, 0, 0}}, {0.02}};
  scene.events.lift_off = OnEvent::stop;
  scene.time = {3, 0.1};
  return {"lift_off", scene};
}

// Time at which the margin of the scene's one monitor falls through zero, near `about`: the root of
// the quad-precision interpolant of the margins at twelve times around it.
double quad_time(const Scenario& scene, double about) {
  Scenario near = scene;
  constexpr int rows = 2000;
  near.time.end = about + 5 * about / rows;
  near.time.step = near.time.end / rows;
  near.events = {};
  const model::Model model = model::assemble(near, false);
  const model::EventMonitors watched = model::event_monitors(scene);
  const solve::OutputGrid grid(near.time);
  const auto solution = study::solve_reference(model, grid, 1e-20);
  REQUIRE(solution.complete);
  constexpr int points = 11;
  std::vector<double> t(points), f(points);
  for (int i = 0; i < points; ++i) {
    const std::size_t at = grid.size() - points + static_cast<std::size_t>(i);
    std::vector<double> row(solution.row_size);
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = static_cast<double>(solution.row(at)[k]);
    t[i] = grid[at] - about;
    f[i] = margin(watched, 0, model.sample(grid[at], row.data()));
  }
  const auto interpolated = [&](double x) {
    double sum = 0;
    for (int i = 0; i < points; ++i) {
      double term = f[i];
      for (int j = 0; j < points; ++j) {
        if (j != i) term *= (x - t[j]) / (t[i] - t[j]);
      }
      sum += term;
    }
    return sum;
  };
  double from = t.front(), to = t.back();
  REQUIRE(interpolated(from) > 0);
  REQUIRE(interpolated(to) < 0);
  for (int k = 0; k < 80; ++k) {
    const double middle = (from + to) / 2;
    (interpolated(middle) > 0 ? from : to) = middle;
  }
  return about + to;
}

}  // namespace

TEST_CASE("event times agree with quad precision to 1e-9 s, with every integrator") {
  const Case what = GENERATE(edge(), slip(), lift_off());
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  CAPTURE(what.name, int(method));
  const Run run = run_in_memory(what.scene, method, {1e-10, 1e-12}, false);
  REQUIRE(run.outcome.ending == solve::Ending::stopped);
  REQUIRE(run.outcome.occurrences.size() == 1);
  const model::Occurrence& event = run.outcome.occurrences.front();
  CHECK(event.name == what.name);
  CHECK(event.stopped);
  CHECK(event.t == run.outcome.reached);
  CHECK(event.t > 0.01);
  CHECK(std::abs(event.t - quad_time(what.scene, event.t)) < 1e-9);
  // All rows before the event, none after it.
  const solve::OutputGrid grid(what.scene.time);
  REQUIRE(run.samples.size() < grid.size());
  CHECK(grid[run.samples.size() - 1] <= event.t);
  CHECK(grid[run.samples.size()] > event.t);
}

TEST_CASE("each onset of an event is noted once") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  Scenario scene = slip().scene;
  scene.events.slip->action = OnEvent::note;
  scene.events.tilt = TiltEvent{0.19, OnEvent::note};
  const Run run = whole_run(scene, method, {1e-9, 1e-11});
  // As often as dense sampling finds the margin falling through zero.
  const model::EventMonitors watched = model::event_monitors(scene);
  scene.events = {};
  scene.time.step = 1e-4;
  const Run close = run_in_memory(scene, method, {1e-9, 1e-11});
  for (std::size_t m = 0; m < watched.monitors.size(); ++m) {
    const std::string name = watched.monitors[m].name();
    double before = margin(watched, m, close.samples.front());
    std::ptrdiff_t onsets = before < 0 ? 1 : 0;
    for (const model::Sample& sample : close.samples) {
      const double now = margin(watched, m, sample);
      if (before >= 0 && now < 0) ++onsets;
      before = now;
    }
    CAPTURE(name);
    CHECK(onsets > 0);
    CHECK(onsets == std::ranges::count(run.outcome.occurrences, name, &model::Occurrence::name));
  }
}

TEST_CASE("a dip below zero between two checks of a step is found") {
  // The ball oscillates along x and just passes the edge: it is beyond it for 2 ms.
  Scenario scene = fig2a();
  scene.ball.position = {0, 0};
  scene.ball.velocity = {0.2, 0};
  scene.gimbal.motion = {{-0.05}, {0.0}};
  const double slowing = 5.0 / 7 * scene.gravity * std::sin(0.05);
  const double furthest = 0.2 * 0.2 / (2 * slowing), turn = 0.2 / slowing;
  const double half_time = 1e-3;
  scene.plate.diameter = 2 * (furthest - slowing * half_time * half_time / 2);
  scene.events.edge = OnEvent::note;
  scene.time = {2 * turn, 2 * turn};
  for (const Method method : {Method::radau, Method::bdf, Method::adams}) {
    const Run run = run_in_memory(scene, method, {1e-9, 1e-11}, false);
    CAPTURE(int(method));
    REQUIRE(run.outcome.occurrences.size() == 1);
    // The edge is crossed at a slope of slowing * half_time: a 1e-9 m error is 3e-6 s.
    CHECK(std::abs(run.outcome.occurrences.front().t - (turn - half_time)) < 1e-5);
  }
}

TEST_CASE("an event at the very start counts") {
  Scenario scene = edge().scene;
  scene.ball.position = {0.5, 0};
  const Run run = run_in_memory(scene, Method::automatic, {1e-9, 1e-11}, false);
  CHECK(run.outcome.ending == solve::Ending::stopped);
  CHECK(run.outcome.reached == 0);
  CHECK(run.samples.size() == 1);
}

TEST_CASE("a one-axis tilt at a constant rate from rest: the closed form, at any height") {
  // s = g / ((2 + k) W^2) (sqrt(1 + k) sinh(W t / sqrt(1 + k)) - sin(W t)).
  const double k = GENERATE(0.4, 2.0 / 3, 1.0);
  const double height = GENERATE(0.0, 0.08);
  const Method method = GENERATE(Method::radau, Method::bdf);
  Scenario scene = fig2a();
  const double rate = 0.7, g = scene.gravity;
  scene.ball.position = {0, 0};
  scene.ball.inertia_factor = k;
  scene.gimbal.mounting.height = height;
  scene.gimbal.motion = {{Ramp{0, rate}}, {}};
  scene.time = {3, 0.1};
  const Run run = whole_run(scene, method, {1e-11, 1e-13});
  for (const model::Sample& sample : run.samples) {
    const double root = std::sqrt(1 + k), t = sample.t;
    const double s =
        g / ((2 + k) * rate * rate) * (root * std::sinh(rate * t / root) - std::sin(rate * t));
    CHECK(std::abs(sample.ball.x - s) < 1e-8 * (1 + s));
    CHECK(sample.ball.y == 0);
  }
}

TEST_CASE("a monitored motion that overflows ends with a reason") {
  // Rocking throws the ball out; its margins reach 1e300 before its position does.
  Scenario scene = fig2a();
  scene.ball.radius = 0.02;
  scene.ball.position = {0, 0};
  scene.gimbal.motion = {{Sinusoid{0.1, 200, 0, 0}}, {}};
  scene.events.slip = SlipEvent{0.02, OnEvent::note};
  scene.time = {100, 1};
  const Run run = run_in_memory(scene, Method::automatic, {1e-8, 1e-10});
  CHECK(run.outcome.ending == solve::Ending::failed);
  CHECK(run.outcome.reached > 50);
  CHECK_FALSE(run.outcome.reason.empty());
}

TEST_CASE("the state at a stop has the ball's turn and the controller's measurement") {
  SECTION("gamma") {
    Scenario scene = edge().scene;
    scene.ball.spin = 3;
    const Run run = run_in_memory(scene, Method::automatic, {1e-11, 1e-13});
    REQUIRE(run.outcome.ending == solve::Ending::stopped);
    const model::Occurrence& stop = run.outcome.occurrences.back();
    Scenario until = scene;
    until.events = {};
    until.time = {stop.t, stop.t};
    const Run whole = run_in_memory(until, Method::automatic, {1e-11, 1e-13});
    CHECK(std::abs(stop.sample.gamma - whole.samples.back().gamma) < 1e-8);
    // It is unknown unless requested.
    const Run without = run_in_memory(scene, Method::automatic, {1e-11, 1e-13}, false);
    CHECK(std::isnan(without.outcome.occurrences.back().sample.gamma));
  }
  SECTION("the last sample") {
    const Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/falls.yaml");
    const Run run = run_in_memory(scene, Method::automatic, {1e-8, 1e-10});
    REQUIRE(run.outcome.ending == solve::Ending::stopped);
    const model::Sample& at = run.outcome.occurrences.back().sample;
    // Less than a period and a sensor delay before, 0.14 s at some 0.5 m/s.
    CHECK(at.measured[0] != 0);
    CHECK(std::abs(at.measured[0] - at.ball.x) < 0.1);
  }
}

}  // namespace bbsim_test::test_events
