// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of prescribed motions in lanes, compared with single runs.
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "support/sweep_setup.hpp"
#include "sweep/runners.hpp"
#include "sweep/sweep.hpp"

namespace bbsim_test::test_open_lanes {

using namespace bbsim;
using namespace bbsim::sweep;

namespace {

const std::vector<std::string> usual{"end_x", "end_y", "max_distance", "max_tilt", "max_tilt_rate"};
const Variation amplitude{"gimbal.motion.phi.sinusoid.amplitude", "uniform:0.005:0.015"};
const Variation phase{"gimbal.motion.theta.sinusoid.phase", "uniform:0:3"};

}  // namespace

TEST_CASE("coarse tolerances are met in lanes as in single runs") {
  const std::vector<std::string> fine{"solver.rtol=1e-12", "solver.atol=1e-14"};
  for (const double rtol : {1e-4, 1e-6, 1e-9}) {
    char set[2][40];
    std::snprintf(set[0], sizeof set[0], "solver.rtol=%g", rtol);
    std::snprintf(set[1], sizeof set[1], "solver.atol=%g", rtol / 100);
    const Setup coarse("configs/fig2a.yaml", {amplitude, phase}, {set[0], set[1]}, usual, 43);
    const Setup exact("configs/fig2a.yaml", {amplitude, phase}, fine, usual, 43);
    const Engine engine = choose_engine(coarse.task);
    REQUIRE(engine.name == "open lanes");
    const CaseResults lanes = run_all(*engine.runner(), coarse.task);
    const CaseResults runs = run_all(*single_runner(exact.task), exact.task);
    for (std::size_t i = 0; i < lanes.numbers.size(); ++i) {
      CHECK(std::abs(lanes.numbers[i] - runs.numbers[i]) < rtol);
    }
  }
}

TEST_CASE("results in lanes do not depend on threads or on shards") {
  const Setup setup("configs/fig2a.yaml",
                    {amplitude, {"gimbal.motion.theta.sinusoid.frequency", "uniform:0.2:6"}}, {},
                    usual, 403);
  const Engine engine = choose_engine(setup.task);
  REQUIRE(engine.name == "open lanes");
  const CaseResults whole = run_all(*engine.runner(), setup.task);
  for (const std::size_t threads : {1, 2, 3}) {
    for (const std::size_t shards : {1, 3}) {
      std::vector<double> numbers;
      for (std::size_t k = 1; k <= shards; ++k) {
        // Chosen again, as in another process.
        const Engine again = choose_engine(setup.task);
        REQUIRE(run_sweep(
            again, shard_range(setup.plan.cases(), again.group, k, shards), threads, goes_on,
            [](CaseResults&) {},
            [&](const CaseResults& some) {
              numbers.insert(numbers.end(), some.numbers.begin(), some.numbers.end());
            }));
      }
      CHECK(numbers == whole.numbers);
    }
  }
}

TEST_CASE("cases that diverge under a prescribed motion run singly") {
  // From 60 rad/s on the plane eventually throws the ball beyond the range of doubles.
  const Setup setup(
      "configs/fig2a.yaml",
      {{"gimbal.motion.phi.ramp.rate", "list:0.01,0.02,200"}, {"ball.mass", "uniform:1:2"}},
      {"gimbal.motion.phi={ramp: {start: 0, rate: 0.01}}"}, usual, 15);
  const Engine engine = choose_engine(setup.task);
  REQUIRE(engine.name == "open lanes");
  const CaseResults lanes = run_all(*engine.runner(), setup.task);
  const CaseResults runs = run_all(*single_runner(setup.task), setup.task);
  const std::size_t numbers = 1 + usual.size();
  int failed = 0;
  check_endings(lanes, runs);
  for (std::size_t i = 0; i < setup.plan.cases(); ++i) {
    if (runs.status[i].word == "done") continue;
    ++failed;
    for (std::size_t n = 0; n < numbers; ++n) {
      CHECK(lanes.numbers[i * numbers + n] == runs.numbers[i * numbers + n]);
    }
  }
  CHECK(failed == 15);
}

}  // namespace bbsim_test::test_open_lanes
