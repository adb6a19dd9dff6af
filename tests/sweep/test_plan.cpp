// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The cases of a sweep.
#include <yaml-cpp/yaml.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "base/error.hpp"
#include "base/real.hpp"
#include "catch.hpp"
#include "support/folder.hpp"
#include "sweep/plan.hpp"

namespace bbsim_test::test_plan {

using namespace bbsim;
using namespace bbsim::sweep;

namespace {

const std::string scene = BBSIM_SOURCE_DIR "/configs/fig2a.yaml";

Sweep vary(std::vector<Variation> keys) {
  Sweep sweep;
  sweep.vary = std::move(keys);
  return sweep;
}

SweepPlan plan_of(const Sweep& sweep) {
  return {ScenarioFamily(scene, {}), sweep};
}

std::string fault(const Sweep& sweep, const std::string& file = scene,
                  const std::vector<std::string>& set = {}) {
  return message_of<InputError>([&] {
    const ScenarioFamily family(file, set);
    const SweepPlan plan(family, sweep);
    static_cast<void>(plan.check(family, 0, plan.cases(), [](double) { return true; }));
  });
}

std::array<double, 2> values(const SweepPlan& plan, std::size_t number) {
  std::array<double, 2> at{};
  plan.values(number, at.data());
  return at;
}

}  // namespace

TEST_CASE("random values depend only on seed, key and case") {
  Sweep sweep = vary({{"gravity", "uniform:9:10"}, {"ball.spin", "normal:5:2"}});
  sweep.samples = 2000;
  const SweepPlan plan = plan_of(sweep);
  REQUIRE(plan.cases() == 2000);
  double sum = 0, squares = 0, least = 10, most = 9;
  std::set<double> different;
  for (std::size_t i = 0; i < plan.cases(); ++i) {
    const auto [uniform, normal] = values(plan, i);
    least = std::min(least, uniform);
    most = std::max(most, uniform);
    sum += normal;
    squares += (normal - 5) * (normal - 5);
    different.insert(uniform);
  }
  CHECK(different.size() == 2000);
  CHECK(least >= 9);
  CHECK(least < 9.01);
  CHECK(most > 9.99);
  CHECK(most <= 10);
  // Four standard errors.
  CHECK(std::abs(sum / 2000 - 5) < 4 * 2 / std::sqrt(2000));
  CHECK(std::abs(squares / 2000 - 4) < 4 * 4 * std::sqrt(2.0 / 2000));

  SECTION("another key does not change them") {
    std::swap(sweep.vary[0], sweep.vary[1]);
    const SweepPlan turned = plan_of(sweep);
    for (const std::size_t i : {0, 1, 1999}) {
      CHECK(values(turned, i)[0] == values(plan, i)[1]);
      CHECK(values(turned, i)[1] == values(plan, i)[0]);
    }
  }
  SECTION("another seed changes them") {
    sweep.seed = 2;
    CHECK(values(plan_of(sweep), 0)[0] != values(plan, 0)[0]);
  }
  SECTION("with a list each value gets equally many draws") {
    sweep.vary[1].spec = "list:1,2,3";
    const SweepPlan mixed = plan_of(sweep);
    CHECK(mixed.cases() == 6000);
    CHECK(values(mixed, 1999)[1] == 1);
    CHECK(values(mixed, 2000)[1] == 2);
    CHECK(values(mixed, 2000)[0] != values(mixed, 0)[0]);
  }
}

TEST_CASE("numbers of a table's offset are in SI units, whatever the unit of the table") {
  const ScenarioFamily family(
      Source{std::string(BBSIM_SOURCE_DIR) + "/configs/scene.yaml",
             "ball: {radius: 1 cm}\n"
             "gimbal: {motion: {theta: 0, phi: {table: {file: recorded-angles.csv, time: t, value: "
             "phi, unit: deg, offset: 2}}}}\n"
             "time: {end: 1, step: 0.1}\n",
             {}});
  const std::string key = "gimbal.motion.phi.table.offset";
  const SweepPlan listed(family, {{key, {0, 0.01}}}, 2);
  CHECK(family.number_at(key, listed.settings(1)) == 0.01);
  const SweepPlan swept(family, vary({{key, "list:0,1 deg"}}));
  CHECK(*family.number_at(key, swept.settings(1)) == Approx(0.017453292519943295));
}

TEST_CASE("values between ends whose difference overflows are finite and in order") {
  const std::string spec =
      GENERATE("linear:-1e308:1e308:7", "linear:-1.7e308:1.7e308:100", "uniform:-1.7e308:1.7e308");
  Sweep sweep = vary({{"ball.position.0", spec}});
  if (spec.starts_with("uniform")) sweep.samples = 100;
  const SweepPlan plan = plan_of(sweep);
  double last = -infinity;
  for (std::size_t i = 0; i < plan.cases(); ++i) {
    double value = 0;
    plan.values(i, &value);
    CHECK(std::isfinite(value));
    if (!sweep.samples) CHECK(value > last);
    last = value;
  }
}

TEST_CASE("a sweep is refused before it runs, with the case and the keys at fault") {
  const YAML::Node all = YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/sweep/refused.yaml");
  CHECK(all.size() > 40);
  for (const YAML::Node& one : all) {
    CAPTURE(YAML::Dump(one));
    Sweep sweep;
    for (const YAML::Node& key : one["vary"]) {
      sweep.vary.push_back({key[0].as<std::string>(), key[1].as<std::string>()});
    }
    if (one["zip"]) sweep.combine = Combine::zip;
    if (one["samples"]) sweep.samples = one["samples"].as<double>();
    const std::string file = one["scene"].as<std::string>("configs/fig2a.yaml");
    using Words = std::vector<std::string>;
    const std::string said =
        fault(sweep, BBSIM_SOURCE_DIR "/" + file, one["set"].as<Words>(Words{}));
    CAPTURE(said);
    CHECK(said.starts_with(one["starts"].as<std::string>("")));
    CHECK(said.find(one["says"].as<std::string>(" ")) != std::string::npos);
  }
}

TEST_CASE("a sweep that resembles a refused one is accepted") {
  Sweep drawn = vary({{"ball.radius", "normal:0.01:0.001"}});
  drawn.samples = 10000;
  CHECK(fault(drawn).empty());
  // --set of the list above the key, or of another item, is allowed: part of it remains.
  const Sweep one = vary({{"ball.position.0", "list:1,2"}});
  CHECK(fault(one, scene, {"ball.position.1=5"}).empty());
  CHECK(fault(one, scene, {"ball.position=[7, 8]"}).empty());
}

}  // namespace bbsim_test::test_plan
