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
#include "sweep/plan.hpp"

namespace bbsim_test::test_plan {

using namespace bbsim;
using namespace bbsim::sweep;

namespace {

const std::string scene = BBSIM_SOURCE_DIR "/configs/fig2a.yaml";
const std::string loop = BBSIM_SOURCE_DIR "/configs/fig2b.yaml";

Sweep vary(std::vector<Variation> keys) {
  Sweep sweep;
  sweep.vary = std::move(keys);
  return sweep;
}

SweepPlan plan_of(const Sweep& sweep, const std::string& file = scene) {
  return {ScenarioFamily(file, {}), sweep};
}

std::string fault(const Sweep& sweep, const std::string& file = scene,
                  const std::vector<std::string>& set = {}) {
  try {
    const ScenarioFamily family(file, set);
    const SweepPlan plan(family, sweep);
    static_cast<void>(plan.check(family, 0, plan.cases(), [](double) { return true; }));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::array<double, 2> values(const SweepPlan& plan, std::size_t number) {
  std::array<double, 2> at{};
  plan.values(number, at.data());
  return at;
}

}  // namespace

TEST_CASE("a grid has every combination, the last key fastest, in SI units") {
  const SweepPlan plan = plan_of(vary(
      {{"ball.position.0", "linear:-10 cm:10 cm:5"}, {"ball.radius", "list:1 cm,0.02,30 mm"}}));
  REQUIRE(plan.cases() == 15);
  CHECK(values(plan, 0) == std::array{-0.1, 0.01});
  CHECK(values(plan, 1) == std::array{-0.1, 0.02});
  CHECK(values(plan, 3) == std::array{-0.05, 0.01});
  CHECK(values(plan, 14) == std::array{0.1, 0.03});
}

TEST_CASE("log uses equal factors and ends exactly") {
  const SweepPlan plan =
      plan_of(vary({{"gravity", "log:0.1:100:4"}, {"ball.spin", "log:-1:-4:3"}}));
  CHECK(values(plan, 0) == std::array{0.1, -1.0});
  CHECK(values(plan, 3)[0] == 1);
  CHECK(values(plan, 1)[1] == Approx(-2));
  CHECK(values(plan, 11) == std::array{100.0, -4.0});
  const SweepPlan wide =
      plan_of(vary({{"gravity", "log:1e-200:1e160:3"}, {"ball.spin", "list:1"}}));
  CHECK(values(wide, 1)[0] == Approx(1e-20));
}

TEST_CASE("zip takes one value from each key") {
  Sweep sweep = vary({{"gravity", "linear:1:3:3"}, {"ball.spin", "list:7,8,9"}});
  sweep.combine = Combine::zip;
  const SweepPlan plan = plan_of(sweep);
  REQUIRE(plan.cases() == 3);
  CHECK(values(plan, 1) == std::array{2.0, 8.0});
}

TEST_CASE("zipped values are checked with those of their own case only") {
  // Each start is within its own limit; the second would exceed the first limit.
  Sweep sweep = vary({{"gimbal.servo.angle_limit", "list:0.2,0.5"},
                      {"gimbal.start.phi", GENERATE("list:0.1,0.4", "linear:0.1:0.4:2")}});
  const bool turned = GENERATE(false, true);
  if (turned) std::swap(sweep.vary[0], sweep.vary[1]);
  sweep.combine = Combine::zip;
  CHECK(fault(sweep, loop) == "");
  CHECK(values(plan_of(sweep, loop), 1) == (turned ? std::array{0.4, 0.5} : std::array{0.5, 0.4}));
}

TEST_CASE("a standard deviation has the key's unit and need not be one of its values") {
  const std::string loop = BBSIM_SOURCE_DIR "/configs/rig.yaml";
  for (const auto& [key, spec] : {std::pair("controller.sampling.period", "normal:20 ms:1e-9"),
                                  {"ball.radius", "normal:0.02:0"},
                                  {"solver.rtol", "normal:1e-8:1e-15"},
                                  {"-2*ball.position.0", "normal:1 cm:0.2 cm"}}) {
    Sweep sweep = vary({{key, spec}});
    sweep.samples = 4;
    CHECK(fault(sweep, loop) == "");
  }
  for (const char* const spec : {"normal:0.02:-1e-3", "normal:0.02:1 s", "normal:0.02:x"}) {
    Sweep sweep = vary({{"ball.radius", spec}});
    sweep.samples = 4;
    CHECK(fault(sweep, loop).find("ball.radius: found ") != std::string::npos);
  }
}

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

TEST_CASE("text values are listed as texts") {
  const SweepPlan plan = plan_of(
      vary({{"solver.method", "list:radau,bdf"}, {"controller.pd.kp", "list:0,[[2, 0], [0, -3]]"}}),
      loop);
  CHECK_FALSE(plan.axes()[0].numeric);
  CHECK_FALSE(plan.axes()[1].numeric);
  REQUIRE(plan.cases() == 4);
  const auto settings = plan.settings(3);
  CHECK(settings[0].value == "bdf");
  CHECK(settings[1].value == "[[2, 0], [0, -3]]");
}

TEST_CASE("tied keys vary together, each with its factor") {
  const SweepPlan plan =
      plan_of(vary({{"ball.position.0,-ball.position.1", "linear:-10 cm:10 cm:5"}}));
  REQUIRE(plan.cases() == 5);
  REQUIRE(plan.axes().size() == 2);
  CHECK(plan.axes()[0].key == "ball.position.0");
  CHECK(plan.axes()[1].key == "ball.position.1");
  CHECK(values(plan, 0) == std::array{-0.1, 0.1});
  CHECK(values(plan, 1) == std::array{-0.05, 0.05});
  CHECK(values(plan, 2) == std::array{0.0, 0.0});
  CHECK_FALSE(std::signbit(values(plan, 2)[1]));
  CHECK(plan.settings(4)[1].key == "ball.position.1");
  CHECK(plan.settings(4)[1].value == "-0.1");

  // The first key may have a factor too; the values are those without it.
  const SweepPlan scaled =
      plan_of(vary({{" -2 * ball.position.0 , 0.5*ball.position.1", "list:1 cm,4"}}));
  CHECK(values(scaled, 0) == std::array{-0.02, 0.005});
  CHECK(values(scaled, 1) == std::array{-8.0, 2.0});

  SECTION("with others they form one axis of a grid") {
    const SweepPlan grid =
        plan_of(vary({{"ball.position.0,ball.position.1", "list:1,2"}, {"gravity", "list:5,6,7"}}));
    REQUIRE(grid.cases() == 6);
    std::array<double, 3> at{};
    grid.values(4, at.data());
    CHECK(at == std::array{2.0, 2.0, 6.0});
  }
  SECTION("and one of a zip") {
    Sweep sweep = vary({{"ball.position.0,ball.position.1", "list:1,2"}, {"gravity", "list:5,6"}});
    sweep.combine = Combine::zip;
    const SweepPlan zip = plan_of(sweep);
    REQUIRE(zip.cases() == 2);
    std::array<double, 3> at{};
    zip.values(1, at.data());
    CHECK(at == std::array{2.0, 2.0, 6.0});
  }
  SECTION("random values are drawn once") {
    Sweep sweep = vary({{"ball.position.0,-3*ball.position.1", "normal:0.1:0.02"}});
    sweep.samples = 50;
    const SweepPlan drawn = plan_of(sweep);
    sweep.vary[0].key = "ball.position.0";
    const SweepPlan alone = plan_of(sweep);
    for (const std::size_t i : {0, 1, 49}) {
      CHECK(values(drawn, i)[0] == values(alone, i)[0]);
      CHECK(values(drawn, i)[1] == -3 * values(drawn, i)[0]);
    }
  }
  SECTION("texts stay unchanged") {
    const SweepPlan texts =
        plan_of(vary({{"controller.pd.kv,controller.pd.kp", "list:0,[[2, 0], [0, -2]]"}}), loop);
    REQUIRE(texts.cases() == 2);
    CHECK(texts.settings(1)[0].value == "[[2, 0], [0, -2]]");
    CHECK(texts.settings(1)[1].value == "[[2, 0], [0, -2]]");
    CHECK(texts.axes()[1].texts[1] == "[[2, 0], [0, -2]]");
  }
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
