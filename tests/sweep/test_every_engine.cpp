// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What every engine owes, whichever stage equations it solves and whatever lies in its lanes: the
// nodes of one run, or the cases of a sweep. The referee is CVODE, which shares no method with
// them.
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "catch.hpp"
#include "solve/output_grid.hpp"
#include "support/largest.hpp"
#include "support/sweep_setup.hpp"
#include "sweep/runners.hpp"
#include "sweep/sweep.hpp"

namespace bbsim_test::test_every_engine {

using namespace bbsim;
using namespace bbsim::sweep;
using Words = std::vector<std::string>;

namespace {

// Scenes for each kind of stage equations. `small_plate` is one that some balls leave. Without
// `switches`, lanes leave scenes with events, and trajectories, to single runs.
struct GivenMotion {
  static constexpr bool switches = false;
  static constexpr const char* scene = "configs/fig2a.yaml";
  static Words set() { return {"time={end: 10, step: 0.37}"}; }
  static Variation vary() {
    return {"gimbal.motion.phi.sinusoid.amplitude", "linear:0.002:0.02:40"};
  }
  static constexpr const char* small_plate = "plate.size=[0.3, 1.4]";
};
struct CoupledLoop {
  static constexpr bool switches = false;
  static constexpr const char* scene = "configs/fig2b.yaml";
  static Words set() { return {"time={end: 10, step: 0.37}"}; }
  static Variation vary() { return {"controller.reference.circle.radius", "linear:0.02:0.08:9"}; }
  static constexpr const char* small_plate = "plate.size=[0.104, 0.104]";
};
// Without what is rounded or drawn, which turns a difference of 1e-16 into a step.
struct SampledRig {
  static constexpr bool switches = true;
  static constexpr const char* scene = "configs/rig.yaml";
  static Words set() {
    return {"time={end: 6, step: 0.37}",
            "controller.sampling.resolution=null",
            "controller.sensor={delay: 10 ms}",
            "gimbal.servo.dead_band=null",
            "events=null",
            "ball.position=[9 cm, 0]"};
  }
  static Variation vary() { return {"controller.gravity_compensation.kp", "linear:6:14:9"}; }
  static constexpr const char* small_plate = "plate.size=[0.1816, 0.24]";
};
struct LinkedRig : SampledRig {
  static Words set() {
    Words words = SampledRig::set();
    words.emplace_back("gimbal.linkage={horn: 2.4 cm, arm: 6 cm, offset: [-1.6 cm, 7 cm]}");
    words.emplace_back("gimbal.servo.angle_limit=60 deg");
    return words;
  }
};

template <class Scene, bool in_lanes>
struct Engine {
  using Of = Scene;

  static Setup setup(const Words& more, const Words& names, const std::string& tolerance) {
    Words set = Scene::set();
    set.insert(set.end(), more.begin(), more.end());
    set.push_back("solver.rtol=" + tolerance);
    set.push_back("solver.atol=" + tolerance);
    return {Scene::scene, {Scene::vary()}, set, names};
  }
  static std::unique_ptr<CaseRunner> runner(const SweepTask& task, bool smooth = true) {
    if (!in_lanes) return single_runner(task);
    const sweep::Engine engine = choose_engine(task);
    REQUIRE((engine.group > 1) == (smooth || Scene::switches));
    return engine.runner();
  }
  static CaseResults run(const Words& more, const Words& names,
                         const std::string& tolerance = "1e-11", bool smooth = true) {
    const Setup all = setup(more, names, tolerance);
    return run_all(*runner(all.task, smooth), all.task);
  }
  static CaseResults referee(Words more, const Words& names) {
    more.emplace_back("solver.method=adams");
    const Setup all = setup(more, names, "1e-13");
    return run_all(*single_runner(all.task), all.task);
  }
};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = largest_finite(largest, {std::abs(a[i] - b[i])});
  }
  return largest;
}

const Words ends{"end_x", "end_y"};
// The motions amplify an error at most this often: an error of the tolerance in each of a few
// hundred steps.
constexpr double steps = 500;
// What CVODE leaves at its tightest.
constexpr double referee_error = 1e-9;

}  // namespace

#define EVERY_ENGINE                                                                        \
  (Engine<GivenMotion, false>), (Engine<GivenMotion, true>), (Engine<CoupledLoop, false>),  \
      (Engine<CoupledLoop, true>), (Engine<SampledRig, false>), (Engine<SampledRig, true>), \
      (Engine<LinkedRig, false>), (Engine<LinkedRig, true>)

TEMPLATE_TEST_CASE("an error is below the tolerance times the steps", "[engines]", EVERY_ENGINE) {
  const auto exact = TestType::referee({}, ends);
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    CAPTURE(tolerance);
    const auto made = TestType::run({}, ends, std::to_string(tolerance * 1e10) + "e-10");
    CHECK(largest_difference(made.numbers, exact.numbers) < steps * tolerance + referee_error);
  }
}

TEMPLATE_TEST_CASE("a ball that leaves its plate stops its run then and there", "[engines]",
                   EVERY_ENGINE) {
  const Words events{TestType::Of::small_plate, "events={edge: stop}"};
  const auto exact = TestType::referee(events, ends);
  const auto made = TestType::run(events, ends, "1e-11", false);
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < made.count; ++i) {
    CHECK(made.status[i].word == exact.status[i].word);
    if (made.status[i].word == "stopped") ++stopped;
  }
  CHECK(stopped > 0);
  CHECK(stopped < made.count);
  CHECK(largest_difference(made.numbers, exact.numbers) < steps * 1e-11 + referee_error);
}

TEMPLATE_TEST_CASE("an event that is noted changes no motion", "[engines]", EVERY_ENGINE) {
  const auto without = TestType::run({}, ends);
  const auto noted =
      TestType::run({TestType::Of::small_plate, "events={edge: note}"}, ends, "1e-11", false);
  CHECK(largest_difference(noted.numbers, without.numbers) < steps * 1e-11);
}

TEMPLATE_TEST_CASE("rows between steps are as exact as steps", "[engines]", EVERY_ENGINE) {
  const auto rows = [](Setup& all, const auto& runner) {
    all.task.series = {scenario::find_column("x"), scenario::find_column("vy")};
    all.task.series_in_lanes = true;
    all.task.series_rows = solve::OutputGrid(all.family.read(all.plan.settings(0)).time).size();
    return run_all(*runner(all.task), all.task);
  };
  Setup all = TestType::setup({"time.step=0.0137"}, {}, "1e-11");
  Setup referee = TestType::setup({"time.step=0.0137", "solver.method=adams"}, {}, "1e-13");
  const auto made = rows(all, [](const SweepTask& task) { return TestType::runner(task, false); });
  const auto exact = rows(referee, [](const SweepTask& task) { return single_runner(task); });
  REQUIRE(made.series.size() == 2);
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK(largest_difference(made.series[c], exact.series[c]) < steps * 1e-11 + referee_error);
  }
}

TEMPLATE_TEST_CASE("a greatest value is found between rows", "[engines]", EVERY_ENGINE) {
  const Words greatest{"max_distance", "max_tilt", "max_tilt_rate"};
  const auto made = TestType::run({"time.step=5"}, greatest);
  // Rows 1 ms apart miss at most a v^2-like curvature times the square of half a millisecond.
  const auto exact = TestType::referee({"time.step=1 ms"}, greatest);
  CHECK(largest_difference(made.numbers, exact.numbers) < 1e-7);
}

TEMPLATE_TEST_CASE("each column's extremes in lanes are those of single runs", "[engines]",
                   GivenMotion, CoupledLoop, SampledRig, LinkedRig) {
  using Alone = Engine<TestType, false>;
  const Scenario scenario = Alone::setup({}, {}, "1e-11").family.read({});
  const Words second{"time.end=1"};
  std::size_t compared = 0;
  for (const std::string_view name : scenario::measured_columns()) {
    CAPTURE(name);
    if (scenario::missing(*scenario::find_column(name), scenario)) continue;
    // One measure at a time: others may keep pieces that this one does not need.
    for (const char* const extreme : {"max_", "min_"}) {
      const Words measure{extreme + std::string(name)};
      const Setup all = Alone::setup(second, measure, "1e-11");
      const sweep::Engine engine = choose_engine(all.task);
      if (engine.group == 1) continue;  // columns of integrals
      const auto made = run_all(*engine.runner(), all.task), alone = Alone::run(second, measure);
      // Accelerations go up to 100.
      CHECK(largest_difference(made.numbers, alone.numbers) < 100 * steps * 1e-11);
      ++compared;
    }
  }
  CHECK(compared > (TestType::switches ? 60 : 2));
}

TEMPLATE_TEST_CASE("an interrupt ends a run between its steps", "[engines]", EVERY_ENGINE) {
  const Setup all = TestType::setup({}, ends, "1e-11");
  const std::atomic<bool> stop{true};
  CaseResults results;
  CHECK(TestType::runner(all.task)->run(0, all.plan.cases(), results, stop) == 0);
}

}  // namespace bbsim_test::test_every_engine
