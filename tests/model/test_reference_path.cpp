// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reference paths against formulas and finite differences, and their properties at knots.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include "model/model.hpp"
#include "model/random_states.hpp"
#include "model/signals/signal_pair.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_reference_path {

using namespace bbsim;
using namespace bbsim::model;

namespace {

constexpr double epsilon = 2.3e-16;

const std::vector<Pair> corners{{0.05, 0}, {0.05, 0.04}, {-0.03, 0.04}, {-0.03, -0.02}};
const std::vector<double> hours{1, 2, 2.5, 4};

// Central differences: the truncation error is h^2/6 times the third derivative of the function,
// and rounding adds eps (value / h).
void check_derivatives(const SignalPair& path, double t, double third, double fourth) {
  const double h = 1e-5, size = 0.2;  // m
  const auto before = path.at(t - h), here = path.at(t), after = path.at(t + h);
  for (std::size_t i = 0; i < 2; ++i) {
    CAPTURE(t, i);
    const double rate = (after[i].value - before[i].value) / (2 * h);
    const double acceleration = (after[i].rate - before[i].rate) / (2 * h);
    CHECK(std::abs(rate - here[i].rate) < h * h * third / 6 + 20 * epsilon * size / h);
    // Speeds stay below ten sizes per second.
    CHECK(std::abs(acceleration - here[i].acceleration) <
          h * h * fourth / 6 + 20 * epsilon * 10 * size / h);
  }
}

void check_hold(const SignalPair& path) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (const double t : {-3.0, 0.0, 0.999}) {
      CHECK(path.at(t)[i].value == corners.front()[i]);
      CHECK(path.at(t)[i].rate == 0);
      CHECK(path.at(t)[i].acceleration == 0);
    }
    for (const double t : {4.0, 4.001, 100.0}) {
      CHECK(path.at(t)[i].value == corners.back()[i]);
      CHECK(path.at(t)[i].rate == 0);
      CHECK(path.at(t)[i].acceleration == 0);
    }
  }
}

}  // namespace

TEST_CASE("a Lissajous figure is an independent cosine and sine") {
  const LissajousReference figure{{0.06, 0.04}, {3, 2}, {0.3, -0.5}, {0.01, 0.02}};
  const SignalPair path = reference_path(figure, 20);
  for (const double t : {0.0, 0.9, 12.0}) {
    const auto [x, y] = path.at(t);
    const double a = 3 * t + 0.3, b = 2 * t - 0.5;
    const double bound = 8 * epsilon * (1 + 3 * t);  // as above; lengths and rates below 1
    CHECK(std::abs(x.value - (0.01 + 0.06 * std::cos(a))) < bound);
    CHECK(std::abs(x.rate + 0.18 * std::sin(a)) < bound);
    CHECK(std::abs(x.acceleration + 0.54 * std::cos(a)) < bound);
    CHECK(std::abs(y.value - (0.02 + 0.04 * std::sin(b))) < bound);
    CHECK(std::abs(y.rate - 0.08 * std::cos(b)) < bound);
    CHECK(std::abs(y.acceleration + 0.16 * std::sin(b)) < bound);
    check_derivatives(path, t, 0.06 * 27, 0.06 * 81);
  }
  CHECK(path.highest_frequency() == 3);
  CHECK(path.knots().empty());
}

TEST_CASE("a Lissajous figure with one rate and radius is the circle, bit for bit") {
  const SignalPair circle = reference_path(CircleReference{0.05, -0.3, 0.7, {0.02, 0}}, 20);
  const SignalPair figure =
      reference_path(LissajousReference{{0.05, 0.05}, {-0.3, -0.3}, {0.7, 0.7}, {0.02, 0}}, 20);
  for (const double t : {0.0, 3.7, 20.0}) {
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(circle.at(t)[i].value == figure.at(t)[i].value);
      CHECK(circle.at(t)[i].rate == figure.at(t)[i].rate);
    }
  }
}

TEST_CASE("constant components cost no sine") {
  CHECK(reference_path(CircleReference{0, 5, 0, {0.1, 0}}, 20).highest_frequency() == 0);
  CHECK(reference_path(LissajousReference{{0.1, 0}, {2, 5}, {}, {}}, 20).highest_frequency() == 2);
  // With rate zero, a cos(phase) remains.
  const auto [x, y] =
      reference_path(LissajousReference{{0.1, 0.1}, {0, 0}, {1, 1}, {}}, 20).at(3.0);
  CHECK(std::abs(x.value - 0.1 * std::cos(1)) < 4 * epsilon);
  CHECK(std::abs(y.value - 0.1 * std::sin(1)) < 4 * epsilon);
  CHECK(x.rate == 0);
}

TEST_CASE("waypoints: C2 in between, at rest at both ends, constant outside") {
  const SignalPair path = reference_path(WaypointReference{corners, hours, false}, 20);
  CHECK(path.knots() == hours);
  check_hold(path);
  for (std::size_t k = 0; k < hours.size(); ++k) {
    const double h = 1e-9;
    const auto left = path.at(hours[k] - h), here = path.at(hours[k]),
               right = path.at(hours[k] + h);
    for (std::size_t i = 0; i < 2; ++i) {
      CAPTURE(k, i);
      CHECK(std::abs(here[i].value - corners[k][i]) < 20 * epsilon);
      // Across 2 h the derivatives change by 2 h times the next one, at most 10 here.
      CHECK(std::abs(left[i].rate - right[i].rate) < 2 * h * 10);
      if (k > 0 && k + 1 < hours.size()) {
        CHECK(std::abs(left[i].acceleration - right[i].acceleration) < 2 * h * 10);
        CHECK(std::abs(here[i].rate) > 1e-3);  // it does not stop there
      }
    }
  }
  Random random(3);
  for (int n = 0; n < 50; ++n) {
    const double t = random.uniform(1, 4);
    const bool near = std::any_of(hours.begin(), hours.end(),
                                  [t](double knot) { return std::abs(t - knot) < 1e-4; });
    if (!near) check_derivatives(path, t, 10, 0);  // cubic pieces
  }
}

TEST_CASE("the clamped spline converges with fourth order") {
  const auto error = [](int n) {
    WaypointReference way;
    for (int i = 0; i <= n; ++i) {  // -cos has slope zero at 0 and pi
      way.times.push_back(std::numbers::pi * i / n);
      way.points.push_back({-std::cos(way.times.back()), 0});
    }
    const SignalPair path = reference_path(way, 20);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
      const double t = std::numbers::pi * i / 500;
      worst = std::max(worst, std::abs(path.at(t)[0].value + std::cos(t)));
    }
    return worst;
  };
  CHECK(std::log2(error(20) / error(40)) > 3.7);  // observed order, one-sided
}

TEST_CASE("waypoints with rests: minimum-jerk quintics") {
  const SignalPair path = reference_path(WaypointReference{corners, hours, true}, 20);
  CHECK(path.knots() == hours);
  check_hold(path);
  for (std::size_t k = 0; k + 1 < hours.size(); ++k) {
    const double T = hours[k + 1] - hours[k];
    for (const double tau : {0.0, 0.1, 0.5, 0.77, 1.0 - 1e-12}) {
      const double t = hours[k] + tau * T, s = (t - hours[k]) / T;  // with the rounding of time
      const auto at = path.at(t);
      for (std::size_t i = 0; i < 2; ++i) {
        CAPTURE(k, i, tau);
        const double step = corners[k + 1][i] - corners[k][i];
        const double value = corners[k][i] + step * s * s * s * (10 + s * (-15 + 6 * s));
        const double rate = step / T * 30 * s * s * (1 - s) * (1 - s);
        const double acceleration = step / (T * T) * 60 * s * (1 - s) * (1 - 2 * s);
        // Coefficients up to 180 (of the acceleration) over T^2, at least 0.25 s^2, and a step of
        // up to 0.08 m cancel to zero at the end.
        const double bound = 4 * epsilon * 180 * 0.08 / 0.25;
        CHECK(std::abs(at[i].value - value) < bound);
        CHECK(std::abs(at[i].rate - rate) < bound);
        CHECK(std::abs(at[i].acceleration - acceleration) < bound);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(path.at(hours[k])[i].value == corners[k][i]);
      CHECK(path.at(hours[k])[i].rate == 0);
      CHECK(path.at(hours[k])[i].acceleration == 0);
    }
  }
}

TEST_CASE("a table of a path reproduces cubics") {
  TableReference table{"path.csv", {0, 0.5, 1.2, 2, 3.5, 4}, {}, {}};
  const auto x = [](double t) { return 0.1 + t * (-0.2 + t * (0.05 + t * 0.01)); };
  const auto y = [](double t) { return -0.1 + t * (0.1 - t * 0.03); };
  for (const double t : table.times) {
    table.x.push_back(x(t));
    table.y.push_back(y(t));
  }
  const SignalPair path = reference_path(table, 20);
  CHECK(path.knots() == table.times);
  for (const double t : {0.0, 0.3, 1.9, 3.99}) {
    // Divided differences over the shortest interval, 0.5 s, on values up to 1.
    CHECK(std::abs(path.at(t)[0].value - x(t)) < 200 * epsilon);
    CHECK(std::abs(path.at(t)[1].value - y(t)) < 200 * epsilon);
    CHECK(std::abs(path.at(t)[0].rate - (-0.2 + t * (0.1 + t * 0.03))) < 400 * epsilon);
    CHECK(std::abs(path.at(t)[1].rate - (0.1 - t * 0.06)) < 400 * epsilon);
  }
}

TEST_CASE("knots of a reference path within the scene are stops") {
  Scenario scene = fig2b();
  CHECK(assemble(scene, false).stops.empty());
  scene.time.end = 4;
  scene.controller->reference = WaypointReference{corners, hours, GENERATE(false, true)};
  const Model model = assemble(scene, false);
  CHECK(model.stops == std::vector<double>{1, 2, 2.5});
  scene.controller->reference = TableReference{"p.csv", {0, 1, 3, 5}, {0, 1, 0, 1}, {0, 0, 0, 0}};
  CHECK(assemble(scene, false).stops == std::vector<double>{1, 3});
}

TEST_CASE("a staircase holds each point, and has jumped at an instant subject to rounding") {
  const SignalPair path =
      reference_path(StaircaseReference{{{0.01, 0}, {0.02, 0}, {0.02, 0.03}}, {0.9, 2}}, 5);
  const auto is_at = [&](double t, double x, double y) {
    CAPTURE(t);
    CHECK(path.at(t)[0].value == x);
    CHECK(path.at(t)[1].value == y);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(path.at(t)[i].rate == 0);
      CHECK(path.at(t)[i].acceleration == 0);
    }
  };
  is_at(-3, 0.01, 0);
  is_at(0, 0.01, 0);
  is_at(0.9 * (1 - 1e-14), 0.01, 0);
  const double ninth = 30 * 0.03;  // time of a sampler with a period of 30 ms
  CHECK(ninth < 0.9);
  is_at(ninth, 0.02, 0);
  is_at(0.9, 0.02, 0);
  is_at(2, 0.02, 0.03);
  is_at(100, 0.02, 0.03);
  CHECK(path.knots() == std::vector<double>{0.9, 2});
  CHECK(path.knots(true) == path.knots());
}

TEST_CASE("a jump at the run's end or to the same value does not happen, one at its start has") {
  const StaircaseReference stairs{{{1, 0}, {2, 0}, {3, 0}}, {0, 2}};
  CHECK(reference_path(stairs, 2).at(2.0)[0].value == 2);
  CHECK(reference_path(stairs, 2.5).at(2.0)[0].value == 3);
  CHECK(reference_path(stairs, 0).at(0.0)[0].value == 2);
  const StaircaseReference flat{{{1, 0}, {1, 0}, {2, 0}, {2, 0}}, {1, 2, 3}};
  CHECK(reference_path(flat, 5).knots(true) == std::vector<double>{2});
}

TEST_CASE("a square wave is the sign of a sine, with phases and a duty") {
  const double T = 0.8;
  const SquareReference square{{0.05, 0.02}, T, {0.3, -2}, {0.01, -0.01}, 0.5};
  const SignalPair path = reference_path(square, 6);
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    const double t = random.uniform(0, 6);
    for (std::size_t i = 0; i < 2; ++i) {
      const double wave = std::sin(2 * std::numbers::pi * t / T + square.phase[i]);
      if (std::abs(wave) < 1e-9) continue;  // within rounding of a jump
      CAPTURE(t, i);
      CHECK(path.at(t)[i].value ==
            square.centre[i] + (wave > 0 ? square.amplitude[i] : -square.amplitude[i]));
    }
  }
  CHECK(path.knots(true) == path.knots());

  const SignalPair quarter = reference_path(SquareReference{{1, 0}, 4, {0, 0}, {0, 5}, 0.25}, 10);
  for (const double t : {0.0, 0.99, 4.0, 4.5, 8.0}) CHECK(quarter.at(t)[0].value == 1);
  for (const double t : {1.0, 2.0, 3.99, 5.0, 7.9}) CHECK(quarter.at(t)[0].value == -1);
  CHECK(quarter.at(3.0)[1].value == 5);
}

TEST_CASE("jumps of a reference within the scene are stops, with the moments just before them") {
  Scenario scene = fig2b();
  scene.time.end = 4;
  scene.controller->reference = SquareReference{{0.05, 0.05}, 2, {0, 0}, {0, 0}, 0.5};
  const Model model = assemble(scene, false);
  CHECK(model.stops == std::vector<double>{1, 2, 3});
  CHECK(model.jumps == model.stops);
  CHECK(model.jumps_at(2));
  CHECK(model.jumps_at(2 * (1 - epsilon)));
  CHECK_FALSE(model.jumps_at(2 * (1 - 1e-13)));
  CHECK_FALSE(model.jumps_at(std::numeric_limits<double>::infinity()));
  const auto path = reference_path(scene.controller->reference, 4);
  CHECK(path.at(2.0)[0].value == 0.05);
  // Also at a rounded sum of times that should end there.
  CHECK(path.at(model.just_before(2) * (1 + epsilon))[0].value == -0.05);
  CHECK(2 - model.just_before(2) < 1e-14);
  CHECK(model.just_before(1.5) == std::nextafter(1.5, 0.0));
}

}  // namespace bbsim_test::test_reference_path
