// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of prescribed motions in lanes, compared with single runs.
#include <atomic>
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
const std::vector<std::string> fine{"solver.rtol=1e-12", "solver.atol=1e-14"};
const Variation amplitude{"gimbal.motion.phi.sinusoid.amplitude", "uniform:0.005:0.015"};
const Variation phase{"gimbal.motion.theta.sinusoid.phase", "uniform:0:3"};

struct Setup : bbsim_test::Setup {
  Setup(const std::string& scene, std::vector<Variation> vary, const std::vector<std::string>& set,
        const std::vector<std::string>& names = usual, double samples = 43)
      : bbsim_test::Setup(scene, std::move(vary), set, names, samples) {}
};

std::vector<std::string> with(std::vector<std::string> set, const std::string& more) {
  set.push_back(more);
  return set;
}

double difference_from_single(const Setup& setup) {
  const Engine engine = choose_engine(setup.task);
  REQUIRE(engine.name == "open lanes");
  const CaseResults lanes = run_all(*engine.runner(), setup.task);
  const CaseResults runs = run_all(*single_runner(setup.task), setup.task);
  CHECK(lanes.values == runs.values);
  check_endings(lanes, runs);
  return largest_difference(runs, lanes);
}

}  // namespace

TEST_CASE("prescribed motions of every kind in lanes agree with single runs") {
  const auto check = [](const Setup& setup) {
    // Both have a tolerance of 1e-12, over distances up to some meters.
    CHECK(difference_from_single(setup) < 2e-11);
  };
  const std::string fig2a = "configs/fig2a.yaml";
  check({fig2a, {amplitude, phase}, fine});
  // Frequencies share no sines.
  check({fig2a,
         {{"gimbal.motion.phi.sinusoid.frequency", "uniform:0.3:4"},
          {"gimbal.motion.theta.sinusoid.frequency", "uniform:0.3:4"}},
         fine});
  // Large angles and all initial values of a ball.
  check({fig2a,
         {{"gimbal.motion.phi.sinusoid.amplitude", "uniform:-2:2"},
          {"ball.velocity.0", "uniform:-0.2:0.2"},
          {"ball.spin", "uniform:-20:20"},
          {"ball.radius", "uniform:0.005:0.05"},
          {"gravity", "uniform:1:20"}},
         with(fine, "time.end=3")});
  const std::string sums =
      "gimbal.motion={phi: [{sinusoid: {amplitude: 0.01, frequency: 1}}, {sinusoid: {amplitude: "
      "0.01, frequency: 2.5}}], theta: [{ramp: {start: 0, rate: 0.001}}, 0.001]}";
  check({fig2a,
         {{"gimbal.motion.phi.0.sinusoid.offset", "uniform:-0.002:0.002"},
          {"gimbal.motion.phi.1.sinusoid.amplitude", "uniform:0:0.01"},
          {"gimbal.motion.theta.0.ramp.rate", "uniform:-0.001:0.001"},
          {"gimbal.motion.theta.1", "uniform:-0.001:0.001"}},
         with(fine, sums)});
  // Planar scenes, all or some.
  for (const char* still : {"uniform:0:0.05", "list:0,0.05"}) {
    check({"configs/incline.yaml",
           {{"gimbal.motion.phi.ramp.rate", "uniform:0.01:0.02"}, {"ball.position.1", still}},
           with(with(fine, "gimbal.motion.phi={ramp: {start: 0, rate: 0.01}}"), "time.end=2")});
  }
  check({fig2a,
         {amplitude, phase},
         fine,
         {"end_vx", "end_spin", "end_normal_force", "end_phi", "end_x", "end_energy", "max_tilt"}});
  // Between the knots of tables, together with a varying sinusoid.
  check({"configs/recorded.yaml",
         {{"ball.spin", "uniform:-3:3"},
          {"gimbal.motion.theta.1.sinusoid.amplitude", "uniform:0.001:0.002"}},
         fine,
         {"end_x", "end_y", "end_vx", "max_distance", "max_tilt", "max_tilt_rate"}});
}

TEST_CASE("coarse tolerances are met in lanes as in single runs") {
  for (const double rtol : {1e-4, 1e-6, 1e-9}) {
    char set[2][40];
    std::snprintf(set[0], sizeof set[0], "solver.rtol=%g", rtol);
    std::snprintf(set[1], sizeof set[1], "solver.atol=%g", rtol / 100);
    const Setup coarse("configs/fig2a.yaml", {amplitude, phase}, {set[0], set[1]});
    const Setup exact("configs/fig2a.yaml", {amplitude, phase}, fine);
    const Engine engine = choose_engine(coarse.task);
    REQUIRE(engine.name == "open lanes");
    const CaseResults lanes = run_all(*engine.runner(), coarse.task);
    const CaseResults runs = run_all(*single_runner(exact.task), exact.task);
    for (std::size_t i = 0; i < lanes.numbers.size(); ++i) {
      CHECK(std::abs(lanes.numbers[i] - runs.numbers[i]) < rtol);
    }
  }
}

TEST_CASE("sweeps in open lanes are those of many simple motions, without events") {
  struct Sweep {
    std::string engine;
    Variation vary = phase;
    std::vector<std::string> set{}, names = usual;
    double samples = 100;
    std::string scene = "configs/fig2a.yaml";
  };
  const std::string open = "open lanes", single = "single runs";
  for (const Sweep& one :
       {Sweep{open}, Sweep{open, phase, {"solver.rtol=1e-13"}},
        Sweep{open, {"gravity", "uniform:1:2"}},
        Sweep{single, phase, {}, usual, 31},  // few cases, which keep the bits of a run
        Sweep{single, phase, {}, {"min_x"}}, Sweep{single, phase, {}, {"end_gamma"}},
        Sweep{single, phase, {"ball.inertia_factor=0.5"}},
        Sweep{single, phase, {"events.lift_off=note"}}, Sweep{single, phase, {"solver.method=bdf"}},
        Sweep{single, phase, {"solver.error=1e-6"}},
        Sweep{single, {"gimbal.mounting.height", "uniform:0:0.01"}},
        Sweep{"lanes", {"gravity", "uniform:1:2"}, {}, {"end_x"}, 100, "configs/fig2b.yaml"}}) {
    const Setup setup(one.scene, {one.vary}, one.set, one.names, one.samples);
    CAPTURE(one.vary.key, one.set, one.names, one.samples);
    CHECK(choose_engine(setup.task).name == one.engine);
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

TEST_CASE("long motions agree with single runs") {
  // 4000 rad in some 600 steps, each with an error up to the tolerance. The plate shakes so little
  // that errors do not grow.
  const std::vector<std::string> shaken =
      with(with(fine, "gimbal.motion.theta.sinusoid.frequency=400"),
           "gimbal.motion.theta.sinusoid.amplitude=1e-4");
  CHECK(difference_from_single(Setup("configs/fig2a.yaml", {amplitude}, shaken)) < 600 * 1e-12);
}

}  // namespace bbsim_test::test_open_lanes
