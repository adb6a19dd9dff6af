// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The C++ library as its header documents it, through the shared library.
#include <algorithm>
#include <bbsim/bbsim.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace bbsim_test::test_library {

namespace {

const std::string configs = BBSIM_SOURCE_DIR "/configs/";

bbsim::Scenario circle() {
  return bbsim::Scenario::from_file(configs + "fig2b.yaml").set("time.end", 1);
}

// The faults with which the call is refused.
template <class Call>
std::vector<bbsim::Fault> faults_of(const Call& call) {
  try {
    call();
  } catch (const bbsim::ScenarioError& error) {
    CHECK(std::string(error.what()).size() > 0);
    return error.faults();
  }
  FAIL("nothing was refused");
  return {};
}

}  // namespace

TEST_CASE("a scenario is a value, and copies have their own settings") {
  const bbsim::Scenario small = circle();
  bbsim::Scenario large = small;
  large.set("ball.radius", "3 cm");
  CHECK(small.check() != large.check());
  bbsim::Scenario again = large;
  CHECK(again.check() == large.check());
  again.set("ball.radius", "1 cm");
  CHECK(again.check() == small.check());
  const bbsim::Scenario moved = std::move(again);
  CHECK(moved.check() == small.check());
}

TEST_CASE("text with a key removed by null equals the scenario without the key") {
  const bbsim::Scenario text = bbsim::Scenario::from_text(
      "ball: {radius: \"2 cm\", spin: 3}\ngimbal: {motion: {phi: \"1 deg\"}}\n"
      "time: {end: 1, step: 0.1}\n");
  bbsim::Scenario without = text;
  without.set("ball.spin", "null");
  CHECK(bbsim::run(text).column("x").size() == 11);
  CHECK(text.check() != without.check());
}

TEST_CASE("a refusal lists every fault with place, key and hint") {
  const auto faults = faults_of([] {
    (void)bbsim::run(
        bbsim::Scenario::from_text("ball: {radius: -1}\ntime: {ende: 1}\n", "mine.yaml"));
  });
  CHECK(faults.size() > 1);
  const auto radius = std::ranges::find(faults, "ball.radius", &bbsim::Fault::key);
  REQUIRE(radius != faults.end());
  CHECK(radius->place.starts_with("mine.yaml:1:"));
  CHECK(radius->hint.starts_with("allowed: "));
}

TEST_CASE("impossible requests are refused like faulty scenarios") {
  CHECK_FALSE(faults_of([] { (void)bbsim::run(circle(), {.measures = {"max_tild"}}); }).empty());
  CHECK_FALSE(faults_of([] { (void)bbsim::linearize(circle(), "plan"); }).empty());
  CHECK_FALSE(faults_of([] { (void)bbsim::Scenario::from_file(configs + "none.yaml"); }).empty());
  CHECK_FALSE(faults_of([] { (void)bbsim::Scenario::from_text("a: [1").check(); }).empty());
  CHECK_FALSE(faults_of([] { (void)bbsim::run(circle()).column("z"); }).empty());
  // The scene has no samples; the second would need several runs.
  CHECK_FALSE(faults_of([] { const bbsim::Stepper stepper(circle()); }).empty());
  const bbsim::Scenario rig = bbsim::Scenario::from_file(configs + "rig.yaml");
  CHECK_FALSE(faults_of([&] {
                const bbsim::Stepper stepper(bbsim::Scenario(rig).set("solver.error", 1e-6));
              }).empty());
}

TEST_CASE("rows to the result, to a callback or to neither are the same") {
  const bbsim::Result whole = bbsim::run(circle(), {.measures = {"max_tilt"}});
  CHECK(whole.status == bbsim::Status::done);
  REQUIRE(whole.values.size() == whole.columns.size());
  std::vector<std::vector<double>> rows;
  bbsim::RunOptions options;
  options.measures = {"max_tilt"};
  options.keep_rows = false;
  options.sink = [&rows](std::span<const double> row) {
    rows.emplace_back(row.begin(), row.end());
  };
  const bbsim::Result streamed = bbsim::run(circle(), options);
  CHECK(streamed.measures == whole.measures);
  CHECK_FALSE(faults_of([&] { (void)streamed.column("x"); }).empty());
  REQUIRE(rows.size() == whole.values[0].size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < whole.columns.size(); ++c) CHECK(rows[r][c] == whole.values[c][r]);
  }
}

TEST_CASE("a file that cannot be written has its own kind of error") {
  CHECK_THROWS_AS(bbsim::run(circle(), {.file = "/dev/null/x.csv"}), bbsim::FileError);
}

TEST_CASE("work stops when its caller asks, and exceptions of callbacks pass through") {
  bbsim::RunOptions options;
  options.goes_on = [](double) { return false; };
  CHECK(bbsim::run(circle().set("time.end", 1e7), options).status == bbsim::Status::interrupted);
  options.goes_on = nullptr;
  options.sink = [](std::span<const double>) { throw std::string("enough"); };
  CHECK_THROWS_AS(bbsim::run(circle(), options), std::string);
}

TEST_CASE("a stepper given the commands of a run repeats the run") {
  const bbsim::Scenario rig = bbsim::Scenario::from_file(configs + "rig.yaml").set("time.end", 1);
  bbsim::Stepper stepper(rig);
  CHECK_FALSE(faults_of([&] { (void)stepper.result(); }).empty());
  std::size_t samples = 0;
  for (; !stepper.is_over(); ++samples) {
    CHECK(stepper.sample().number == samples);
    stepper.step({0.01, -0.01});
  }
  CHECK(samples == 51);  // every 20 ms, including both ends
  bbsim::Stepper again(rig);
  while (!again.is_over()) again.step({0.01, -0.01});
  CHECK(again.result().values == stepper.result().values);
  CHECK_FALSE(faults_of([&] { stepper.step({0, 0}); }).empty());
}

TEST_CASE("a stepper's own sink cannot step it, but may move it") {
  std::optional<bbsim::Stepper> stepper, other;
  std::size_t refused = 0;
  bbsim::RunOptions options;
  options.sink = [&](std::span<const double>) {
    if (!stepper) return;
    refused += faults_of([&] { stepper->step({0, 0}); }).size();
    if (!other) other.emplace(std::move(*stepper));
  };
  const bbsim::Scenario rig = bbsim::Scenario::from_file(configs + "rig.yaml").set("time.end", 1);
  stepper.emplace(rig, options);
  while (!other) stepper->step({0.01, 0});
  CHECK(refused > 0);
  while (!other->is_over()) other->step({0.01, 0});
  CHECK(other->result().status == bbsim::Status::done);
}

TEST_CASE("an object that was moved from is refused until it has a value again") {
  bbsim::Scenario scenario = circle();
  const bbsim::Scenario other = std::move(scenario);
  const bbsim::Scenario copy = scenario;  // NOLINT(bugprone-use-after-move): it is the test
  for (const bbsim::Scenario* const empty : {&std::as_const(scenario), &copy}) {
    CHECK_FALSE(faults_of([&] { (void)empty->check(); }).empty());
    CHECK_FALSE(faults_of([&] { (void)bbsim::run(*empty); }).empty());
    CHECK_FALSE(faults_of([&] { (void)bbsim::sweep(*empty); }).empty());
    CHECK_FALSE(faults_of([&] { (void)bbsim::linearize(*empty); }).empty());
    CHECK_FALSE(faults_of([&] { const bbsim::Stepper stepper(*empty); }).empty());
  }
  CHECK_FALSE(faults_of([&] { scenario.set("time.end", 1); }).empty());
  scenario = other;
  CHECK(scenario.check() == other.check());

  bbsim::Stepper stepper(bbsim::Scenario::from_file(configs + "rig.yaml"));
  bbsim::Stepper next = std::move(stepper);
  CHECK_FALSE(faults_of([&] { (void)stepper.is_over(); }).empty());
  CHECK_FALSE(faults_of([&] { (void)stepper.sample(); }).empty());
  CHECK_FALSE(faults_of([&] { stepper.step({0, 0}); }).empty());
  CHECK_FALSE(faults_of([&] { (void)stepper.result(); }).empty());
  next.step({0, 0});
}

TEST_CASE("a sweep has one row per case: a grid, or values together") {
  bbsim::SweepOptions options;
  options.vary = {{"ball.radius", "list:0.01,0.02"}, {"gravity", "list:9,10"}};
  options.measures = {"max_tilt"};
  CHECK(bbsim::sweep(circle(), options).column("case").numbers.size() == 4);
  options.zip = true;
  const bbsim::Table table = bbsim::sweep(circle(), options);
  CHECK(table.complete);
  REQUIRE(table.column("max_tilt").numbers.size() == 2);
  const bbsim::Result one =
      bbsim::run(circle().set("ball.radius", 0.02).set("gravity", 10), {.measures = {"max_tilt"}});
  CHECK(table.column("max_tilt").numbers[1] == Approx(one.measures[0].second).epsilon(1e-6));
  options.goes_on = [](double) { return false; };
  options.vary = {{"ball.radius", "linear:0.01:0.02:4000"}};
  const bbsim::Table ended = bbsim::sweep(circle(), options);
  CHECK_FALSE(ended.complete);
  CHECK(ended.columns.size() == table.columns.size() - 1);  // of one key
  CHECK(ended.column("max_tilt").numbers.size() < 4000);
}

TEST_CASE("a sweep refuses the numbers that the program refuses") {
  const auto refused = [](auto change) {
    bbsim::SweepOptions options;
    options.vary = {{"ball.radius", "uniform:0.01:0.02"}};
    options.samples = 3;
    options.threads = 1;
    CHECK(bbsim::sweep(circle(), options).column("case").numbers.size() == 3);
    change(options);
    return !faults_of([&] { (void)bbsim::sweep(circle(), options); }).empty();
  };
  static constexpr std::size_t huge = std::size_t{1} << 62U;
  CHECK(refused([](bbsim::SweepOptions& options) { options.samples = 0; }));
  CHECK(refused([](bbsim::SweepOptions& options) { options.samples = huge; }));
  CHECK(refused([](bbsim::SweepOptions& options) { options.samples.reset(); }));
  CHECK(refused([](bbsim::SweepOptions& options) { options.seed = huge; }));
  CHECK(refused([](bbsim::SweepOptions& options) { options.threads = huge; }));
  CHECK(refused([](bbsim::SweepOptions& options) { options.vary = {{"gravity", "list:9,10"}}; }));
}

TEST_CASE("a linear system has its names and sizes") {
  const bbsim::LinearSystem plant = bbsim::linearize(circle(), "plant");
  const std::size_t n = plant.states.size();
  CHECK(n == 8);  // position, rate and two servo states per axis
  REQUIRE(plant.a.size() == n);
  CHECK(plant.a[0].size() == n);
  REQUIRE(plant.b.size() == n);
  CHECK(plant.b[0].size() == plant.inputs.size());
  CHECK(plant.c.size() == plant.outputs.size());
  CHECK_FALSE(plant.period);
  CHECK(bbsim::linearize(bbsim::Scenario::from_file(configs + "rig.yaml"), "sampled").period ==
        0.02);
}

}  // namespace bbsim_test::test_library
