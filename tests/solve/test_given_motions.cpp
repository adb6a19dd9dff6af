// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Balls under prescribed motions in lanes, against references and known properties.
#include <cmath>
#include <limits>
#include <numbers>

#include "catch.hpp"
#include "model/signals/signal_pair.hpp"
#include "solve/ensemble_runs.hpp"
#include "study/reference_table.hpp"

namespace bbsim_test::test_given_motions {

using namespace bbsim;
using namespace bbsim::solve::ensemble;

namespace {

constexpr double end = 10;

Ensemble lanes_of(int nodes, double rtol) {
  return {{Actuation::given, solve::OutputGrid(OutputTimes{end, end}), false},
          nodes,
          {rtol, rtol / 100}};
}

// A ball under a motion.
Case ball_under(const model::SignalPair& motion) {
  Case one{};
  one.radius = 0.01;
  one.gravity = 9.81;
  const model::SignalView view = motion.view();
  for (int i = 0; i < 2; ++i) {
    one.start[i] = view.start[i];
    one.rate[i] = view.rate[i];
  }
  one.harmonic_count = static_cast<int>(view.harmonic_count);
  std::copy_n(view.harmonics, view.harmonic_count, one.harmonics);
  return one;
}

// The scene of tests/data/scenarios/fig2a.yaml.
model::SignalPair fig2a_motion() {
  model::SignalPair motion;
  motion.add_sinusoid(0, 0.01, 1, std::numbers::pi / 2);
  motion.add_sinusoid(1, -0.01, 1, 0);
  return motion;
}
Case fig2a(const model::SignalPair& motion = fig2a_motion()) {
  Case one = ball_under(motion);
  one.initial[1] = -0.1;
  return one;
}

}  // namespace

TEST_CASE("balls in lanes agree with the reference, for any number of nodes") {
  const auto last = read_reference_table("fig2a").back();
  const int nodes = GENERATE(8, 12, 16);
  Ensemble lanes = lanes_of(nodes, 1e-12);
  const std::vector<Course> runs = carry(lanes, {fig2a(), fig2a(), fig2a()});
  REQUIRE(are_done(runs));
  for (const Course& run : runs) {
    CAPTURE(nodes);
    // The tolerance, for distances up to 0.7 m and for speeds.
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(run.state[i] == Approx(static_cast<double>(last[1 + i])).margin(3e-12));
    }
    CHECK(run.state[4] == Approx(static_cast<double>(last[5]) * 0.01).margin(3e-12));
    CHECK(std::sqrt(run.greatest[solve::rate_squared]) == Approx(0.01).epsilon(1e-13));
  }
}

TEST_CASE("a looser tolerance takes fewer steps in lanes and gives larger errors") {
  const auto last = read_reference_table("fig2a").back();
  double error_before = 0;
  std::size_t steps_before = std::numeric_limits<std::size_t>::max();
  for (const double rtol : {1e-12, 1e-9, 1e-5}) {
    Ensemble lanes = lanes_of(8, rtol);
    const Course run = carry(lanes, {fig2a()})[0];
    const double error = std::abs(run.state[1] - static_cast<double>(last[2]));
    CHECK(error < 3 * rtol);
    CHECK(error > error_before);
    CHECK(lanes.statistics().steps < steps_before);
    error_before = error;
    steps_before = lanes.statistics().steps;
  }
}

TEST_CASE("under a prescribed motion, hardly any step is repeated") {
  std::vector<Case> cases;
  for (int i = 0; i < 8; ++i) {
    model::SignalPair motion = fig2a_motion();
    motion.add_sinusoid(0, 0.003 * i, 2, 0.3 * i);
    cases.push_back(fig2a(motion));
  }
  const double rtol = GENERATE(1e-5, 1e-9, 1e-12);
  Ensemble lanes = lanes_of(choose_nodes(Actuation::given, rtol, 2 * end), rtol);
  REQUIRE(are_done(carry(lanes, cases)));
  const solve::Statistics statistics = lanes.statistics();
  CAPTURE(rtol, statistics.steps, statistics.error_test_failures);
  CHECK(statistics.error_test_failures <= (rtol == 1e-9 ? 0 : statistics.steps / 20));
  CHECK(statistics.steps > 8);
  CHECK(statistics.steps < 8 * 12);
}

TEST_CASE("the result of a ball depends neither on its companions nor on earlier runs") {
  std::vector<Case> cases;
  for (int i = 0; i < 27; ++i) {
    model::SignalPair motion = fig2a_motion();
    motion.add_sinusoid(1, 0.02 * (i % 5), 0.3 * i, 0.1 * i);
    motion.add_ramp(0, 0, i % 9 == 4 ? 0.1 : 0);  // to angles beyond pi / 4
    cases.push_back(fig2a(motion));
  }
  Ensemble lanes = lanes_of(12, 1e-8);
  CHECK(are_done(carry_in_any_company(lanes, cases)));
}

TEST_CASE("each lane finds its own farthest place between nodes") {
  // Free balls on a level plane move in straight lines: a parabola's minimum is inside, its maximum
  // at an end. On an oscillating plane the maximum is where the ball turns around.
  std::vector<Case> cases;
  for (int i = 0; i < 8; ++i) {
    // x'' = -5/7 g a t (27), without rates; a slow ramp is close enough.
    model::SignalPair motion;
    motion.add_ramp(0, -1e-3 * (1 + 0.1 * i), 0);
    cases.push_back(ball_under(motion));
    cases.back().initial[0] = 0.02 * i;
    cases.back().initial[2] = 0.1;
  }
  Ensemble lanes = lanes_of(12, 1e-12);
  const std::vector<Course> runs = carry(lanes, cases);
  REQUIRE(are_done(runs));
  for (int i = 0; i < 8; ++i) {
    const Course& run = runs[static_cast<std::size_t>(i)];
    const double a = 5.0 / 7 * 9.81 * std::sin(1e-3 * (1 + 0.1 * i)), x = 0.02 * i, v = 0.1;
    // Up to 0.1^2 / (2 a) and back again, and perhaps farther on the other side.
    const double turning = x + v * v / (2 * a), last = x + v * end - a / 2 * end * end;
    const double farthest = v / a < end ? std::max(turning, std::abs(last)) : std::abs(last);
    CHECK(std::sqrt(run.greatest[solve::distance_squared]) == Approx(farthest).epsilon(1e-11));
    CHECK(run.state[0] == Approx(last).epsilon(1e-11));
    CHECK(run.greatest[solve::versine] ==
          Approx(2 * std::pow(std::sin(0.5e-3 * (1 + 0.1 * i)), 2)).epsilon(1e-13));
  }
}

TEST_CASE("a lane that cannot continue is abandoned without affecting the others") {
  std::vector<Case> cases(8, fig2a());
  // A plane that turns at 1e4 rad/s throws its ball beyond the range of doubles.
  cases[2].rate[0] = 1e4;
  cases[5].initial[0] = std::numeric_limits<double>::quiet_NaN();
  Ensemble lanes = lanes_of(12, 1e-9);
  const std::vector<Course> runs = carry(lanes, cases);
  const auto last = read_reference_table("fig2a").back();
  for (std::size_t i = 0; i < 8; ++i) {
    CAPTURE(i);
    const bool fine = i != 2 && i != 5;
    CHECK((runs[i].ending == Ending::done) == fine);
    if (!fine) continue;
    CHECK(runs[i].state[1] == Approx(static_cast<double>(last[2])).margin(1e-8));
  }
}

TEST_CASE("the greatest tilt and rate are those of the motion, for any terms") {
  const int which = GENERATE(range(0, 4));
  model::SignalPair motion;
  if (which < 3) motion.add_sinusoid(0, 0.7, 1.3, 0.2);
  if (which == 1) motion.add_sinusoid(1, 0.4, 2.1, 1.0);
  if (which == 2) motion.add_ramp(1, 0.2, -0.05);
  if (which == 3) {  // equally far in all directions, up to the fourth power of the angle
    motion.add_sinusoid(0, 0.5, 3, 0);
    motion.add_sinusoid(1, 0.5, 3, std::numbers::pi / 2);
  }
  Ensemble lanes = lanes_of(12, 1e-9);
  const std::vector<Course> runs = carry(lanes, {fig2a(motion)});
  REQUIRE(are_done(runs));
  double tilted = 0, rate = 0;
  constexpr int times = 1'000'000;
  for (int i = 0; i <= times; ++i) {
    const auto angles = motion.at(end * i / times);
    const double a = std::sin(angles[0].value / 2), b = std::sin(angles[1].value / 2);
    tilted = std::max(tilted, 2 * (a * a + b * b) - 4 * a * a * b * b);
    rate = std::max(rate, angles[0].rate * angles[0].rate + angles[1].rate * angles[1].rate);
  }
  // Sampling every 1e-5 s misses the maximum by at most a relative 1e-10.
  CHECK(runs[0].greatest[solve::versine] == Approx(tilted).epsilon(1e-9));
  CHECK(runs[0].greatest[solve::rate_squared] == Approx(rate).epsilon(1e-9));
}

}  // namespace bbsim_test::test_given_motions
