// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Groups of balls under given motions, against the reference and against what is known of them.
#include <cmath>
#include <limits>
#include <numbers>

#include "catch.hpp"
#include "model/signals/signal_pair.hpp"
#include "solve/open/open_lanes.hpp"
#include "study/reference_table.hpp"

using namespace bbsim;
using namespace bbsim::solve::open;

namespace {

constexpr double end = 10;

// The scene of tests/data/scenarios/fig2a.yaml.
OpenCase fig2a() {
  OpenCase one;
  one.radius = 0.01;
  one.gravity = 9.81;
  one.initial[1] = -0.1;
  one.motion.add_sinusoid(0, 0.01, 1, std::numbers::pi / 2);
  one.motion.add_sinusoid(1, -0.01, 1, 0);
  return one;
}

OpenCase at_rest_on_level_plane(double x, double velocity) {
  OpenCase one;
  one.radius = 0.01;
  one.gravity = 9.81;
  one.initial[0] = x;
  one.initial[2] = velocity;
  return one;
}

}  // namespace

TEST_CASE("balls in lanes are where the reference says, with any number of nodes") {
  const auto last = read_reference_table("fig2a").back();
  const int nodes = GENERATE(8, 12, 16);
  const OpenCase cases[3] = {fig2a(), fig2a(), fig2a()};
  // A pace that is much too fast costs attempts, and nothing else.
  const double angle = GENERATE(1.0, 100.0);
  OpenLanes lanes({1e-12, 1e-14}, end, {}, {nodes, angle});
  const auto carried = lanes.integrate(cases, 3);
  CHECK((carried[0] && carried[1] && carried[2] && !carried[3]));
  for (int lane = 0; lane < 3; ++lane) {
    const Reached reached = lanes.reached(lane);
    CAPTURE(nodes, angle, lane);
    // The tolerance, of distances up to 0.7 m, and of speeds.
    CHECK(reached.state[0] == Approx(static_cast<double>(last[1])).margin(3e-12));
    CHECK(reached.state[1] == Approx(static_cast<double>(last[2])).margin(3e-12));
    CHECK(reached.state[2] == Approx(static_cast<double>(last[3])).margin(3e-12));
    CHECK(reached.state[3] == Approx(static_cast<double>(last[4])).margin(3e-12));
    CHECK(reached.state[4] == Approx(static_cast<double>(last[5]) * 0.01).margin(3e-12));
    CHECK(std::sqrt(reached.rate_squared) == Approx(0.01).epsilon(1e-13));
  }
}

TEST_CASE("a looser tolerance takes fewer steps in lanes, and errs more") {
  const auto last = read_reference_table("fig2a").back();
  const OpenCase one = fig2a();
  double error_before = 0;
  std::size_t steps_before = std::numeric_limits<std::size_t>::max();
  for (const double rtol : {1e-12, 1e-9, 1e-5}) {
    OpenLanes lanes({rtol, rtol / 100}, end, {}, {8, 1.0});
    static_cast<void>(lanes.integrate(&one, 1));
    const double error = std::abs(lanes.reached(0).state[1] - static_cast<double>(last[2]));
    CHECK(error < 3 * rtol);
    CHECK(error > error_before);
    CHECK(lanes.statistics().steps < steps_before);
    error_before = error;
    steps_before = lanes.statistics().steps;
  }
}

TEST_CASE("a pace that is measured needs no step twice") {
  OpenCase cases[8];
  for (int i = 0; i < 8; ++i) {
    cases[i] = fig2a();
    cases[i].motion.add_sinusoid(0, 0.003 * i, 2, 0.3 * i);
  }
  OpenLanes lanes({1e-9, 1e-11}, end, {}, {});
  const auto measured = lanes.measure(cases, 8);
  REQUIRE(measured);
  OpenLanes paced({1e-9, 1e-11}, end, {}, measured->pace);
  static_cast<void>(paced.integrate(cases, 8));
  CHECK(paced.statistics().error_test_failures == 0);
  CHECK(paced.statistics().steps > 1);
}

TEST_CASE("lanes see the farthest place between two nodes, of each lane its own") {
  // Free balls on a level plane go straight on: the least of a parabola is between, its greatest
  // value at an end; under a tilt to and fro, the greatest is where the ball turns round.
  OpenCase cases[8];
  for (int i = 0; i < 8; ++i) {
    cases[i] = at_rest_on_level_plane(0.02 * i, 0);
    // x'' = -5/7 g a t (27), without rates: none is so exactly, but a ramp is slow enough to be.
    cases[i].initial[2] = 0.1;
    cases[i].motion.add_ramp(0, -1e-3 * (1 + 0.1 * i), 0);
  }
  OpenLanes lanes({1e-12, 1e-14}, end, {}, {});
  const auto carried = lanes.integrate(cases, 8);
  for (int i = 0; i < 8; ++i) {
    REQUIRE(carried[static_cast<std::size_t>(i)]);
    const double a = 5.0 / 7 * 9.81 * std::sin(1e-3 * (1 + 0.1 * i)), x = 0.02 * i, v = 0.1;
    // Up to 0.1^2 / (2 a) and back again, and perhaps farther on the other side.
    const double turning = x + v * v / (2 * a), last = x + v * end - a / 2 * end * end;
    const double farthest = v / a < end ? std::max(turning, std::abs(last)) : std::abs(last);
    CHECK(std::sqrt(lanes.reached(i).distance_squared) == Approx(farthest).epsilon(1e-11));
    CHECK(lanes.reached(i).state[0] == Approx(last).epsilon(1e-11));
    CHECK(lanes.reached(i).versine ==
          Approx(2 * std::pow(std::sin(0.5e-3 * (1 + 0.1 * i)), 2)).epsilon(1e-13));
  }
}

TEST_CASE("a lane that cannot go on is given up, and spoils nothing of the others") {
  OpenCase cases[8];
  for (OpenCase& one : cases) one = fig2a();
  // A plane that turns at 1e4 rad/s throws its ball beyond the range of doubles.
  cases[2].motion.add_ramp(0, 0, 1e4);
  cases[5].initial[0] = std::numeric_limits<double>::quiet_NaN();
  OpenLanes lanes({1e-9, 1e-11}, end, {}, {12, 5.0});
  const auto carried = lanes.integrate(cases, 8);
  const auto last = read_reference_table("fig2a").back();
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    const bool fine = i != 2 && i != 5;
    CHECK(carried[static_cast<std::size_t>(i)] == fine);
    if (!fine) continue;
    CHECK(lanes.reached(i).state[1] == Approx(static_cast<double>(last[2])).margin(1e-8));
  }
}

TEST_CASE("the greatest tilt and rate are those of the motion, whatever it is made of") {
  const int which = GENERATE(range(0, 4));
  struct Both {
    model::SignalPair pair;
    GivenMotion given;
    void add_sinusoid(std::size_t i, double amplitude, double frequency, double phase) {
      pair.add_sinusoid(i, amplitude, frequency, phase);
      given.add_sinusoid(static_cast<int>(i), amplitude, frequency, phase);
    }
    void add_ramp(std::size_t i, double start, double rate) {
      pair.add_ramp(i, start, rate);
      given.add_ramp(static_cast<int>(i), start, rate);
    }
  } motion;
  if (which < 3) motion.add_sinusoid(0, 0.7, 1.3, 0.2);
  if (which == 1) motion.add_sinusoid(1, 0.4, 2.1, 1.0);
  if (which == 2) motion.add_ramp(1, 0.2, -0.05);
  if (which == 3) {  // as far in all directions, but for the fourth power of the angle
    motion.add_sinusoid(0, 0.5, 3, 0);
    motion.add_sinusoid(1, 0.5, 3, std::numbers::pi / 2);
  }
  OpenCase one = fig2a();
  one.motion = motion.given;
  OpenLanes lanes({1e-9, 1e-11}, end, {}, {});
  REQUIRE(lanes.integrate(&one, 1)[0]);
  double versine = 0, rate = 0;
  constexpr int looks = 1'000'000;
  for (int i = 0; i <= looks; ++i) {
    const auto angles = motion.pair.at(end * i / looks);
    const double a = std::sin(angles[0].value / 2), b = std::sin(angles[1].value / 2);
    versine = std::max(versine, 2 * (a * a + b * b) - 4 * a * a * b * b);
    rate = std::max(rate, angles[0].rate * angles[0].rate + angles[1].rate * angles[1].rate);
  }
  // A look every 1e-5 s is beside the top by 1e-10 of it at most.
  CHECK(lanes.reached(0).versine == Approx(versine).epsilon(1e-9));
  CHECK(lanes.reached(0).rate_squared == Approx(rate).epsilon(1e-9));
}
