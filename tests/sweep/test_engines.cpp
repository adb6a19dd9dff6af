// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The engines of a sweep, compared with single runs.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "solve/integrate.hpp"
#include "support/measured.hpp"
#include "support/run_in_memory.hpp"
#include "support/sweep_setup.hpp"
#include "sweep/runners.hpp"
#include "sweep/sweep.hpp"
#include "sweep/task.hpp"
#include "yaml-cpp/yaml.h"

namespace bbsim_test::test_engines {

using namespace bbsim;
using namespace bbsim::sweep;

namespace {

const std::vector<std::string> open_measures{"end_x", "end_y", "max_distance", "max_tilt",
                                             "max_tilt_rate"};
const std::vector<std::string> loop_measures{"end_x",
                                             "end_y",
                                             "max_tilt",
                                             "max_tilt_rate",
                                             "max_distance",
                                             "rms_tracking_error",
                                             "max_tracking_error"};

// Measures from the rows of solve::integrate.
CaseResults one_by_one(const SweepTask& task) {
  CaseResults results;
  results.resize(task.plan.cases(), task);
  const std::size_t numbers = 1 + task.measures.size();
  for (std::size_t i = 0; i < task.plan.cases(); ++i) {
    const Scenario scenario = task.family.read(task.plan.settings(i));
    const MeasuredRun run = measured(scenario, task.measures, scenario.solver.method,
                                     {scenario.solver.rtol, scenario.solver.atol});
    results.numbers[i * numbers] = run.outcome.reached;
    std::ranges::copy(run.values, &results.numbers[i * numbers + 1]);
  }
  return results;
}

}  // namespace

TEST_CASE("a case of a sweep has the measures of a run, to the bit") {
  const auto [scene, key] = GENERATE(table<std::string, std::string>(
      {{"configs/fig2a.yaml", "ball.position.0"}, {"configs/fig2b.yaml", "ball.position.0"}}));
  const Setup setup(scene, {{key, "uniform:-0.1:0.1"}}, {"solver.rtol=1e-9"},
                    scene == "configs/fig2a.yaml" ? open_measures : loop_measures, 5);
  const CaseResults results = run_all(*single_runner(setup.task), setup.task);
  CHECK(results.numbers == one_by_one(setup.task).numbers);
}

TEST_CASE("distances neither overflow nor underflow in between") {
  const double size = GENERATE(1e160, 1e-180);
  char far[80];
  std::snprintf(far, sizeof far, "linear:%g:%g:40", size, 2 * size);
  const Setup setup("configs/fig2a.yaml", {{"ball.position.0", far}},
                    {"ball.position.1=0", "gravity=0", "ball.radius=1e-200"}, {"max_distance"});
  const auto runner = choose_engine(setup.task).runner();
  const auto single = single_runner(setup.task);
  const CaseResults lanes = run_all(*runner, setup.task), runs = run_all(*single, setup.task);
  for (std::size_t i = 0; i < 40; ++i) {
    CHECK(lanes.numbers[2 * i + 1] >= size);
    CHECK(lanes.numbers[2 * i + 1] == Approx(runs.numbers[2 * i + 1]).epsilon(1e-6));
  }
}

TEST_CASE("trajectories are the rows of each case, with NaN beyond its end") {
  Setup setup("configs/fig2b-literal.yaml", {{"controller.pd.kv", "list:0.001,100"}},
              {"time.end=1"}, {"end_x"});
  const solve::OutputGrid grid(setup.family.read(setup.plan.settings(0)).time);
  setup.task.series = {scenario::find_column("x"), scenario::find_column("normal_force")};
  setup.task.series_rows = grid.size();
  const CaseResults results = run_all(*single_runner(setup.task), setup.task);
  REQUIRE(results.series[0].size() == 2 * grid.size());
  for (std::size_t i = 0; i < 2; ++i) {
    const Scenario scenario = setup.family.read(setup.plan.settings(i));
    const model::Model model = model::assemble(scenario, false);
    solve::Trajectory rows(model.row_size());
    static_cast<void>(solve::integrate(model, scenario.solver.method,
                                       {scenario.solver.rtol, scenario.solver.atol}, grid, rows));
    CHECK(rows.rows() == (i == 0 ? grid.size() : 75));
    for (std::size_t row = 0; row < grid.size(); ++row) {
      const double x = results.series[0][i * grid.size() + row];
      const double force = results.series[1][i * grid.size() + row];
      if (row >= rows.rows()) {
        CHECK((std::isnan(x) && std::isnan(force)));
        continue;
      }
      const model::Sample sample = model.sample(grid[row], rows.row(row));
      CHECK(x == sample.ball.x);
      CHECK(force == model::dynamics(sample, model::constants_of(scenario)).normal_force());
    }
  }
}

TEST_CASE("each case is delivered once, in order, for any number of threads") {
  const Setup setup("configs/fig2a.yaml", {{"gimbal.motion.phi.sinusoid.phase", "linear:0:3:301"}},
                    {}, {"end_x"});
  const Engine engine = choose_engine(setup.task);
  for (const std::size_t threads : {1, 2, 7, 400}) {
    std::size_t next = 5;
    const bool finished = run_sweep(
        engine, {5, 300}, threads, goes_on, [](CaseResults&) {},
        [&](const CaseResults& results) {
          CHECK(results.first == next);
          next += results.count;
        });
    CHECK(finished);
    CHECK(next == 300);
  }
}

TEST_CASE("a sweep stops on request, or if its results cannot be stored") {
  const Setup setup("configs/fig2a.yaml", {{"gimbal.motion.phi.sinusoid.phase", "linear:0:3:5000"}},
                    {}, {"end_x"});
  const Engine engine = choose_engine(setup.task);
  std::atomic<bool> stop{false};
  std::size_t delivered = 0;
  CHECK_FALSE(run_sweep(
      engine, {0, 5000}, 2, stop, [](CaseResults&) {},
      [&](const CaseResults& results) {
        delivered += results.count;
        stop = true;
      }));
  CHECK(delivered > 0);
  CHECK(delivered < 5000);
  CHECK_THROWS_AS(run_sweep(
                      engine, {0, 5000}, 2, goes_on, [](CaseResults&) {},
                      [](const CaseResults&) { throw std::runtime_error("full"); }),
                  std::runtime_error);
}

TEST_CASE("shards are whole groups of nearly equal number, and make up the sweep") {
  for (const std::size_t cases : {0, 1, 7, 8, 9, 100, 1000003}) {
    for (const std::size_t group : {1, 8}) {
      for (const std::size_t shards : {1, 2, 3, 10}) {
        std::size_t next = 0, least = cases, most = 0;
        for (std::size_t k = 1; k <= shards; ++k) {
          const CaseRange range = shard_range(cases, group, k, shards);
          CHECK(range.first == next);
          CHECK((range.first % group == 0 || range.first == cases));
          least = std::min(least, range.last - range.first);
          most = std::max(most, range.last - range.first);
          next = range.last;
        }
        CHECK(next == cases);
        CHECK(most - least < 2 * group);
      }
    }
  }
}

namespace {

const std::vector<std::string> coarse{"solver.rtol=1e-6", "solver.atol=1e-8"};

}  // namespace

namespace {

using Words = std::map<std::string, std::string>;
using Reasons = std::map<std::size_t, std::string>;

// All choices of one value for each word.
std::vector<Words> choices(const YAML::Node& each) {
  std::vector<Words> all{{}};
  for (const auto& word : each) {
    std::vector<Words> longer;
    for (Words words : all) {
      for (const YAML::Node& value : word.second) {
        words[word.first.as<std::string>()] = value.as<std::string>();
        longer.push_back(words);
      }
    }
    all = longer;
  }
  return all;
}

std::string filled(const YAML::Node& text, const Words& words) {
  auto made = text.as<std::string>();
  for (const auto& [word, value] : words) {
    const std::size_t at = made.find(word);
    if (at != std::string::npos) made.replace(at, word.size(), value);
  }
  return made;
}

// The sweeps of lanes.yaml that `engine` computes, as single runs do within `bound`.
void check_sweeps(const std::string& engine, double bound) {
  const YAML::Node page = YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/sweep/lanes.yaml");
  for (const YAML::Node& row : page[engine]) {
    for (const Words& words : choices(row["each"])) {
      std::vector<Variation> vary;
      for (const auto& one : row["vary"]) {
        vary.push_back({one.first.as<std::string>(), filled(one.second, words)});
      }
      std::vector<std::string> set;
      for (const YAML::Node& one : row["set"]) set.push_back(filled(one, words));
      CAPTURE(row["what"].as<std::string>(), set);
      const YAML::Node names = row["measures"] ? row["measures"] : page["measures"][engine];
      const Setup setup(filled(row["scene"], words) + ".yaml", vary, set,
                        names.as<std::vector<std::string>>(), row["samples"].as<double>(0));
      const Engine chosen = choose_engine(setup.task);
      CHECK(chosen.name == engine);
      if (engine == "single runs") continue;
      const CaseResults lanes = run_all(*chosen.runner(), setup.task);
      const CaseResults alone = run_all(*single_runner(setup.task), setup.task);
      CHECK(lanes.values == alone.values);
      check_endings(lanes, alone);
      for (const auto& [at, reason] : row["reasons"].as<Reasons>(Reasons{})) {
        CHECK(lanes.status[at].reason == reason);
      }
      if (!row["numbers"].as<bool>(true)) continue;
      CHECK(largest_difference(lanes, alone) < row["bound"].as<double>(bound));
      for (const CaseStatus& status : lanes.status) {
        if (engine == "lanes") CHECK(status.word == "done");
      }
    }
  }
}

}  // namespace

TEST_CASE("loops of all servos, references and tolerances run in lanes") {
  // Within both tolerances of 1e-6, over a loop that amplifies it little.
  check_sweeps("lanes", 1e-4);
}

TEST_CASE("rigs in lanes are those of single runs") {
  // Substitution leaves a thousandth of the tolerance of 1e-10, and a loop that holds the ball
  // damps its errors: 1e-10 after thousands of pieces.
  check_sweeps("rig lanes", 1e-10);
}

TEST_CASE("prescribed motions of every kind in lanes agree with single runs") {
  check_sweeps("open lanes", 2e-11);
}

TEST_CASE("sweeps that lanes do not support use single runs") {
  check_sweeps("single runs", 0);
}

TEST_CASE("loops that diverge in lanes end as single runs do, without affecting others") {
  const Setup setup("configs/fig2b.yaml", {{"controller.pd.kv.0.0", "uniform:-0.4:0.8"}}, {},
                    loop_measures, 60);
  const Engine engine = choose_engine(setup.task);
  REQUIRE(engine.name == "lanes");
  const CaseResults lanes = run_all(*engine.runner(), setup.task);
  const CaseResults alone = run_all(*single_runner(setup.task), setup.task);
  const std::size_t width = 1 + setup.task.measures.size();
  int exploded = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    CAPTURE(i);
    CHECK(lanes.status[i].word == alone.status[i].word);
    CHECK(lanes.status[i].reason == alone.status[i].reason);
    const bool done = lanes.status[i].word == "done";
    if (!done) ++exploded;
    CHECK(lanes.numbers[i * width] ==
          Approx(alone.numbers[i * width]).epsilon(done ? 1e-15 : 1e-4));
    for (std::size_t m = 0; m + 1 < width; ++m) {
      const double ours = lanes.numbers[i * width + 1 + m];
      const double theirs = alone.numbers[i * width + 1 + m];
      // A greatest value on the way to infinity occurs in the last step.
      const bool is_greatest = setup.task.measures[m].kind == scenario::Measure::Kind::greatest;
      if (done) CHECK(std::abs(ours - theirs) < 1e-6);
      if (!done && !is_greatest) CHECK(ours == Approx(theirs).epsilon(1e-3));
    }
  }
  CHECK(exploded > 10);
  CHECK(exploded < 30);

  // Bit for bit for any distribution; also the states at the end, which lanes do not know before
  // infinity.
  const auto runner = engine.runner();
  for (std::size_t first = 0; first < 60; first += 7) {
    CaseResults some;
    const std::size_t count = std::min<std::size_t>(7, 60 - first);
    REQUIRE(runner->run(first, count, some, goes_on) == count);
    for (std::size_t i = 0; i < some.numbers.size(); ++i) {
      CHECK(some.numbers[i] == lanes.numbers[first * width + i]);
    }
  }
  const Setup states("configs/fig2b.yaml", {{"controller.pd.kv.0.0", "uniform:-0.4:0.8"}}, {},
                     {"end_x", "end_vx", "end_phi"}, 60);
  const CaseResults ends = run_all(*choose_engine(states.task).runner(), setup.task);
  const CaseResults expected = run_all(*single_runner(states.task), states.task);
  for (std::size_t i = 0; i < ends.numbers.size(); ++i) {
    CHECK(ends.numbers[i] == Approx(expected.numbers[i]).epsilon(1e-6).margin(1e-7));
  }
}

TEST_CASE("tied keys have the bits of keys that are set, with inserted numbers and read again") {
  for (const char* set : {"ball.spin=0", "events.lift_off=note"}) {
    const Setup tied("configs/fig2b.yaml",
                     {{"controller.pd.kv.0.0,-controller.pd.kv.1.1", "list:0.8,1.2"}}, {set},
                     loop_measures);
    const CaseResults results = run_all(*single_runner(tied.task), tied.task);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string kv = i == 0 ? "0.8" : "1.2";
      const Setup one("configs/fig2b.yaml", {{"controller.pd.kv.1.1", "list:-" + kv}},
                      {set, "controller.pd.kv.0.0=" + kv}, loop_measures);
      const CaseResults alone = run_all(*single_runner(one.task), one.task);
      for (std::size_t n = 0; n < alone.numbers.size(); ++n) {
        CHECK(results.numbers[i * alone.numbers.size() + n] == alone.numbers[n]);
      }
    }
  }
}

TEST_CASE("windows of time within the whole run work with every engine") {
  struct Case {
    std::string scene, engine;
    std::vector<Variation> vary;
    std::vector<std::string> set, names;
    double bound;
  };
  const std::string part = GENERATE("open lanes", "lanes", "rig lanes");
  const std::vector<Case> cases{
      {"configs/fig2a.yaml",
       "open lanes",
       {{"gimbal.motion.phi.sinusoid.phase", "linear:0:1:64"}},
       {},
       {"max_distance", "max_tilt_rate"},
       1e-7},
      {"configs/fig2b.yaml",
       "lanes",
       {{"ball.position.0", "linear:-0.1:0.1:16"}},
       {},
       {"max_tilt", "max_tracking_error"},
       1e-7},
      // Single runs and lanes agree within the tolerance, and use the same noise.
      {"configs/rig.yaml",
       "rig lanes",
       {{"controller.sensor.seed", "linear:1:16:16"}},
       {"time.end=4"},
       {"max_tracking_error", "max_tilt"},
       1e-8}};
  const auto& one = *std::ranges::find(cases, part, &Case::engine);
  const Setup whole(one.scene, one.vary, one.set, one.names);
  const Engine engine = choose_engine(whole.task);
  REQUIRE(engine.name == one.engine);
  const std::size_t count = whole.plan.cases();
  const CaseResults of_whole = run_all(*engine.runner(), whole.task);

  // The greatest value of a run is that of its first or its second part.
  std::vector<std::string> windows;
  for (const std::string& name : one.names) {
    windows.push_back(name + " to 1.3 s");
    windows.push_back(name + " from 1.3 s");
  }
  const Setup parts(one.scene, one.vary, one.set, windows);
  const Engine other = choose_engine(parts.task);
  CHECK(other.name == (part == "rig lanes" ? part : "single runs"));
  const CaseResults of_parts = run_all(*other.runner(), parts.task);
  std::size_t different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double* const all = &of_whole.numbers[i * (1 + one.names.size())];
    const double* const some = &of_parts.numbers[i * (1 + windows.size())];
    for (std::size_t m = 1; m <= one.names.size(); ++m) {
      const double first = some[2 * m - 1], second = some[2 * m];
      CAPTURE(i, m, first, second);
      CHECK(std::max(first, second) == Approx(all[m]).epsilon(one.bound));
      if (second != first) ++different;
    }
  }
  CHECK(different > 0);
  CHECK(largest_difference(of_parts, one_by_one(parts.task)) <= (part == "rig lanes" ? 1e-10 : 0));
}

TEST_CASE("a case that lacks a measure has a reason, and another may have it") {
  const std::string first = GENERATE("{size: [0.3, 0.3]}", "{diameter: 0.3}");
  const std::vector<Variation> plates{
      {"plate", "list:" + first + ",{inertia: [1e-4, 1e-4, 2e-4]}"}};
  const Setup setup("configs/fig2a.yaml", plates, {}, {"end_x"});
  const std::vector<std::string> names{"end_motor_torque_phi", "end_x"};
  const auto found = sweep_measures(names, setup.family, setup.plan);
  REQUIRE(found.size() == 2);
  SweepTask task{setup.family, setup.plan, found};
  const CaseResults results = run_all(*single_runner(task), task);
  CHECK(results.status[0].reason ==
        "end_motor_torque_phi is not a number: plate.inertia is not known");
  CHECK(results.status[1].word == "done");
  CHECK(results.status[1].reason.empty());
  CHECK(std::isnan(results.numbers[1]));
  CHECK(std::isfinite(results.numbers[2]));
  CHECK(std::isfinite(results.numbers[4]));
  // A measure that no case knows is an error, and so is a window that no case has.
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"max_tracking_error"}, {"max_x from 11 s"}, {"end_x", "end_x"}, {"max_z"}}) {
    CHECK_THROWS_AS(sweep_measures(wrong, setup.family, setup.plan), InputError);
  }
  const Setup ends("configs/fig2a.yaml", {{"time.end", "list:1,12"}}, {}, {"end_x"});
  CHECK(sweep_measures({"max_x from 11 s"}, ends.family, ends.plan).size() == 1);
  // Rigs in lanes, of which only the first or the last lack the measure.
  const bool last = GENERATE(false, true);
  const std::string known = "{size: [0.3, 0.2], inertia: [1e-3, 1e-3, 2e-3]}";
  const std::string unknown = "{size: [0.3, 0.2]}";
  const Setup rigs("configs/rig.yaml",
                   {{"plate", "list:" + (last ? known + "," + unknown : unknown + "," + known)},
                    {"ball.position.0", "linear:1 cm:4 cm:8"}},
                   {"time.end=0.5", "output.columns=[t, x]"}, {"end_x", "end_motor_torque_phi"});
  const Engine engine = choose_engine(rigs.task);
  REQUIRE(engine.name == "rig lanes");
  const CaseResults of_rigs = run_all(*engine.runner(), rigs.task);
  for (std::size_t i = 0; i < 16; ++i) {
    const bool lacks = (i >= 8) == last;
    CHECK(std::isfinite(of_rigs.numbers[3 * i + 1]));
    CHECK(std::isfinite(of_rigs.numbers[3 * i + 2]) == !lacks);
    CHECK(of_rigs.status[i].reason ==
          (lacks ? "end_motor_torque_phi is not a number: plate.inertia is not known" : ""));
  }
}

TEST_CASE("a measure that overflows has its reason, by single runs and in lanes") {
  // Row by row, many rows together, and in lanes.
  const auto [scene, measure, engine] = GENERATE(table<std::string, std::string, std::string>({
      {"configs/fig2a.yaml", "max_normal_force", "single runs"},
      {"configs/fig2a.yaml", "end_normal_force", "single runs"},
      {"configs/fig2b.yaml", "end_normal_force", "lanes"},
  }));
  CAPTURE(scene, measure);
  const Setup setup(scene, {{"ball.mass", "list:1,1e308"}}, coarse, {measure});
  const Engine chosen = choose_engine(setup.task);
  REQUIRE(chosen.name == engine);
  const CaseResults results = run_all(*chosen.runner(), setup.task);
  CHECK(results.status[0].word == "done");
  CHECK(results.status[0].reason.empty());
  CHECK(results.status[1].reason == measure + " is infinite");
}

namespace {

const std::vector<Variation> gains_and_seeds{{"controller.gravity_compensation.kp", "uniform:6:14"},
                                             {"controller.gravity_compensation.kv", "uniform:5:10"},
                                             {"controller.sensor.seed", "list:1,2,3"}};

}  // namespace

TEST_CASE("a command that arrives at the end, up to rounding, is in the last row") {
  // 14 periods of 0.05 s round to more than 0.7 s, and so does a sample plus its delay.
  const auto [period, delay, end] = GENERATE(table<std::string, std::string, std::string>(
      {{"0.05", "0", "0.7"}, {"0.02", "0", "0.7"}, {"0.02", "0.03", "0.29"}}));
  CAPTURE(period, end);
  const std::vector<std::string> set{
      "time.step=0.01", "controller.sampling={period: " + period + ", delay: " + delay + "}",
      "time.end=" + end};
  const Setup setup("configs/rig.yaml", {{"ball.position.0", "linear:3 cm:4 cm:8"}}, set,
                    {"end_phi_command", "end_x_measured", "end_phi_acceleration"});
  const Engine engine = choose_engine(setup.task);
  REQUIRE(engine.name == "rig lanes");
  const CaseResults lanes = run_all(*engine.runner(), setup.task);
  CHECK(largest_difference(lanes, one_by_one(setup.task)) < 1e-9);
  // It equals the row of a longer run.
  std::vector<std::string> longer = set;
  longer.back() = "time.end=1";
  const ScenarioFamily family(BBSIM_SOURCE_DIR "/configs/rig.yaml", longer);
  const Scenario scenario = family.read(setup.plan.settings(0));
  const bbsim_test::Run run =
      bbsim_test::run_in_memory(scenario, Method::radau, {1e-8, 1e-10}, false);
  const auto row = static_cast<std::size_t>(std::lround(std::stod(end) / 0.01));
  CHECK(lanes.numbers[1] == Approx(run.samples.at(row).command[0]));
  CHECK(lanes.numbers[2] == Approx(run.samples.at(row).measured[0]));
}

TEST_CASE("rigs in lanes do not depend on the distribution of their groups") {
  // Commands without rounding show the last bit. With 21 cases the last group is not full.
  const std::string sampling = GENERATE("{period: 20 ms, delay: 10 ms, resolution: 0.1 deg}",
                                        "{period: 20 ms, delay: 10 ms}");
  const Setup setup("configs/rig.yaml", gains_and_seeds,
                    {"time.end=2", "controller.sampling=" + sampling}, loop_measures, 7);
  const Engine engine = choose_engine(setup.task);
  REQUIRE(engine.name == "rig lanes");
  const std::size_t cases = setup.plan.cases(), width = 1 + setup.task.measures.size();
  const CaseResults all = run_all(*engine.runner(), setup.task);
  // The groups in reverse, by one runner that keeps its memory.
  const auto runner = engine.runner();
  for (std::size_t first = cases / engine.group * engine.group;; first -= engine.group) {
    CaseResults some;
    REQUIRE(runner->run(first, std::min(engine.group, cases - first), some, goes_on));
    for (std::size_t i = 0; i < some.numbers.size(); ++i) {
      CHECK(some.numbers[i] == all.numbers[first * width + i]);
    }
    if (first == 0) break;
  }
}

TEST_CASE("a sweep to the limits of doubles has no finished case without a finite distance") {
  const Setup setup("configs/fig2a.yaml", {{"ball.position.0", "linear:-1e308:1e308:38"}}, {},
                    {"max_distance", "end_x"});
  const auto runner = choose_engine(setup.task).runner();
  const CaseResults results = run_all(*runner, setup.task);
  const std::size_t numbers = 1 + setup.task.measures.size();
  for (std::size_t i = 0; i < setup.plan.cases(); ++i) {
    const double distance = results.numbers[i * numbers + 1];
    CAPTURE(i, distance);
    if (results.status[i].reason.empty()) CHECK(std::isfinite(distance));
    CHECK(!(distance == 0));
  }
}

}  // namespace bbsim_test::test_engines
