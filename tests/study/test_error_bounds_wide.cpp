// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Thousands of bounds on random scenes: whether they are met, and how good the estimates are. Takes
// minutes, so it only runs by tag: test_study "[wide]". docs/explanation/error-control.md has the
// results.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "catch.hpp"
#include "positions.hpp"
#include "study/error_control.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_error_bounds_wide {

using namespace bbsim;

namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double between(double from, double to) {
    return from + (to - from) * std::generate_canonical<double, 53>(engine_);
  }
  double magnitude(double from, double to) {
    return std::exp(between(std::log(from), std::log(to)));
  }
  int count(int from, int to) { return from + static_cast<int>(between(0, to - from + 1)); }
  bool chance(double p) { return between(0, 1) < p; }

 private:
  std::mt19937_64 engine_;
};

Sinusoid sinusoid(Draw& draw, double most) {
  return {draw.magnitude(1e-3, most), draw.magnitude(0.3, 6), draw.between(0, 6), 0};
}

Table table(Draw& draw, double end) {
  Table made{"", {0}, {draw.between(-0.1, 0.1)}};
  const double mean = end / draw.count(4, 40);
  while (made.times.back() < end || made.times.size() < 4) {
    made.times.push_back(made.times.back() + mean * draw.between(0.4, 1.6));
    made.values.push_back(draw.between(-0.1, 0.1));
  }
  return made;
}

Scenario ball(Draw& draw) {
  Scenario scene;
  scene.gravity = 9.81;
  scene.ball.radius = draw.magnitude(2e-3, 0.05);
  scene.ball.position = {draw.between(-0.1, 0.1), draw.between(-0.1, 0.1)};
  if (draw.chance(0.5)) scene.ball.velocity = {draw.between(-0.3, 0.3), draw.between(-0.3, 0.3)};
  if (draw.chance(0.5)) scene.ball.spin = draw.between(-20, 20);
  scene.time = {draw.between(1, 8), draw.between(0.02, 0.2)};
  return scene;
}

Scenario open_loop(Draw& draw) {
  Scenario scene = ball(draw);
  scene.gimbal.motion = {{sinusoid(draw, 0.3)}, {sinusoid(draw, 0.3)}};
  if (draw.chance(0.3)) scene.gimbal.motion->phi.emplace_back(sinusoid(draw, 0.1));
  return scene;
}

Scenario tabulated(Draw& draw) {
  Scenario scene = ball(draw);
  scene.gimbal.motion = {{table(draw, scene.time.end)}, {table(draw, scene.time.end)}};
  if (draw.chance(0.3)) scene.gimbal.motion->theta = {sinusoid(draw, 0.1)};
  return scene;
}

Scenario loop(Draw& draw) {
  Scenario scene = ball(draw);
  scene.gimbal.servo = Servo{draw.magnitude(10, 300), draw.between(0.5, 1.2)};
  Controller controller;
  const double kv = draw.between(0.3, 1), kp = draw.between(0.2, 1);
  controller.kv = {{{kv, 0}, {0, -kv}}};
  controller.kp = {{{kp, 0}, {0, -kp}}};
  controller.drives = Drives::angle;
  controller.reference = CircleReference{draw.between(0, 0.1), draw.between(-2, 2), 0};
  scene.controller = controller;
  return scene;
}

Scenario past_waypoints(Draw& draw) {
  Scenario scene = loop(draw);
  WaypointReference path;
  const int points = draw.count(3, 12);
  for (int i = 0; i < points; ++i) {
    path.points.push_back({draw.between(-0.1, 0.1), draw.between(-0.1, 0.1)});
    path.times.push_back(scene.time.end * (i + draw.between(0.2, 0.8)) / points);
  }
  path.rest = draw.chance(0.5);
  scene.controller->reference = path;
  return scene;
}

Scenario sampled(Draw& draw) {
  Scenario scene = loop(draw);
  Sampling sampling;
  sampling.period = draw.magnitude(2e-3, 0.05);
  if (draw.chance(0.5)) sampling.delay = sampling.period * draw.between(0, 1.5);
  sampling.derivative_filter = draw.between(0, 0.05);
  scene.controller->sampling = sampling;
  if (draw.chance(0.5)) {
    Sensor sensor;
    if (draw.chance(0.5)) sensor.noise = 1e-4;
    if (draw.chance(0.5)) sensor.delay = sampling.period * draw.between(0, 1.5);
    scene.controller->sensor = sensor;
  }
  scene.time.end = std::min(scene.time.end, 200 * sampling.period);
  return scene;
}

// With a monitor a scene is integrated from switch to switch; its motion is unchanged.
Scenario watched(Draw& draw) {
  Scenario scene = draw.chance(0.5) ? tabulated(draw) : open_loop(draw);
  scene.events.slip = SlipEvent{0.05, OnEvent::note};
  return scene;
}

struct Figures {
  int runs = 0, met = 0, bounds_broken = 0, below_third = 0, integrations = 0;
  std::vector<double> ratios;  // estimate over error, excluding rounding
};

}  // namespace

TEST_CASE("bounds and estimates over thousands of random scenes", "[.][wide]") {
  struct Kind {
    const char* name;
    Scenario (*make)(Draw&);
  };
  constexpr Kind kinds[] = {{"open loop", open_loop}, {"tables", tabulated},
                            {"loop", loop},           {"waypoints", past_waypoints},
                            {"sampled", sampled},     {"watched", watched}};
  constexpr int scenes = 120, bounds = 8;
  for (const Kind& kind : kinds) {
    Figures figures;
    for (int seed = 1; seed <= scenes; ++seed) {
      Draw draw(static_cast<unsigned>(seed));
      Scenario scene = kind.make(draw);
      const model::Model model = model::assemble(scene, false);
      scene.events = {};
      const solve::OutputGrid grid(scene.time);
      const Positions truth = exact_positions(model::assemble(scene, false), grid);
      if (truth.empty()) continue;
      double extent = 0;
      for (const auto& row : truth) {
        for (const double x : row) extent = std::max(extent, std::abs(x));
      }
      // Accuracy of the truth of a sampled loop, given its method; otherwise a double of a quad.
      const double known_to = (kind.make == sampled ? 1e-13 : 1.2e-16) * extent;
      for (int b = 0; b < bounds; ++b) {
        const double bound = draw.magnitude(1e-12, 1e-3);
        solve::Trajectory rows(model.row_size());
        const auto result = study::integrate_to_error(model, Method::automatic, bound, grid, rows);
        CAPTURE(kind.name, seed, bound, result.estimate, result.tolerances.rtol, extent);
        REQUIRE(rows.rows() == truth.size());
        double error = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          for (std::size_t k = 0; k < truth[i].size(); ++k) {
            error = std::max(error, std::abs(rows.row(i)[k] - truth[i][k]));
          }
        }
        CAPTURE(error);
        ++figures.runs;
        figures.integrations += result.runs;
        figures.met += result.met ? 1 : 0;
        const bool broken = result.met && error - known_to > bound;
        const bool below = result.estimate < (error - known_to) / 3;
        figures.bounds_broken += broken ? 1 : 0;
        figures.below_third += below ? 1 : 0;
        CHECK_FALSE(broken);
        CHECK_FALSE(below);
        if (error > 10 * known_to) figures.ratios.push_back(result.estimate / error);
      }
    }
    std::sort(figures.ratios.begin(), figures.ratios.end());
    const auto at = [&](double part) {
      if (figures.ratios.empty()) return 0.0;
      const auto last = static_cast<double>(figures.ratios.size() - 1);
      return figures.ratios[static_cast<std::size_t>(part * last)];
    };
    std::printf(
        "%-10s %5d bounds, %5d met, %d broken, %d below a third; estimate/error least %.3g, "
        "median %.3g, 99%% %.3g, most %.3g (%zu beyond rounding); %.2f integrations each\n",
        kind.name, figures.runs, figures.met, figures.bounds_broken, figures.below_third, at(0),
        at(0.5), at(0.99), at(1), figures.ratios.size(),
        static_cast<double>(figures.integrations) / std::max(1, figures.runs));
    std::fflush(stdout);
  }
}

}  // namespace bbsim_test::test_error_bounds_wide
