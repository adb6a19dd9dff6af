// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Balls under prescribed motions in lanes: nodes, repeated steps and company. Tolerances, greatest
// values and cases that diverge are in tests/sweep.
#include <cmath>
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
    CHECK(std::sqrt(run.greatest[solve::ensemble::rate_squared]) == Approx(0.01).epsilon(1e-13));
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

}  // namespace bbsim_test::test_given_motions
