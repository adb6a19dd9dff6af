// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Units of tables: declared units, and guesses if none are declared.
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "scenario/log_columns.hpp"
#include "support/folder.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_units {

using namespace bbsim;
using namespace bbsim::test;
using namespace bbsim::scenario;
using Catch::Matchers::Contains;

namespace {

// Degrees, millimeters and milliseconds, as in a rig's log.
const char* const rows =
    "t,phi,x,y,f\n"
    "0,0,0,-30,0\n2500,2,100,0,5\n5000,-4,50,30,10\n7500,1,0,0,5\n10000,0,0,0,0\n";

struct Scene {
  explicit Scene(const std::string& table) { folder.put("log.csv", table); }

  [[nodiscard]] Scenario read(const std::string& key, const std::string& extra) const {
    const std::string text =
        "ball: {radius: 0.01, mass: 0.1}\ntime: {end: 10, step: 0.1}\n" + scene(key, extra);
    return parse_scenario(text, folder / "scene.yaml");
  }
  [[nodiscard]] static std::string scene(const std::string& key, const std::string& extra) {
    const std::string table = "{table: {file: log.csv, time: t" + extra;
    if (key == "motion") return "gimbal: {motion: {phi: " + table + ", value: phi}}}}\n";
    return "gimbal: {servo: {natural_frequency: 20, damping: 1}}\n"
           "controller: {pd: {kv: 0, kp: 0}, drives: angle, reference: " +
           table + ", x: x, y: y}}}\n";
  }

  Folder folder;
};

std::string told(const Scenario& scenario) {
  std::string all;
  for (const std::string& remark : scenario.remarks) all += remark + '\n';
  return all;
}

}  // namespace

TEST_CASE("a table is read in its units, without a warning") {
  const Scene scene(rows);
  const Scenario motion = scene.read("motion", ", unit: deg, time_unit: ms");
  const auto& phi = std::get<Table>(motion.gimbal.motion->phi[0]);
  CHECK(phi.times == std::vector<double>{0, 2.5, 5, 7.5, 10});
  CHECK(phi.values[2] == -std::numbers::pi / 45);
  CHECK(told(motion).empty());

  const Scenario path = scene.read("reference", ", unit: mm, time_unit: ms");
  const auto& reference = std::get<TableReference>(path.controller->reference);
  CHECK(reference.x == std::vector<double>{0, 0.1, 0.05, 0, 0});
  CHECK(reference.y == std::vector<double>{-0.03, 0, 0.03, 0, 0});
  CHECK(reference.times.back() == 10);
  CHECK(told(path).empty());
}

TEST_CASE("torques and forces of a table have units too") {
  const Folder folder;
  folder.put("log.csv", "t,f\n0,0\n1,5\n2,10\n3,500\n");
  const Scenario scenario = parse_scenario(
      "ball: {radius: 0.01, mass: 0.1, push: {x: {table: {file: log.csv, time: t, value: f, unit: "
      "mN}}}}\n"
      "plate: {inertia: [1e-3, 1e-3, 2e-3]}\n"
      "gimbal: {torque: {phi: {table: {file: log.csv, time: t, value: f, unit: mN m}}}}\n"
      "time: {end: 3, step: 1}\n",
      folder / "scene.yaml");
  CHECK(std::get<Table>(scenario.ball.push->x[0]).values ==
        std::vector<double>{0, 0.005, 0.01, 0.5});
  CHECK(std::get<Table>(scenario.gimbal.torque->phi[0]).values ==
        std::vector<double>{0, 0.005, 0.01, 0.5});
  CHECK(told(scenario).empty());  // neither looks like another unit
}

TEST_CASE("a table without units gives a warning if it looks like another unit") {
  const Scene scene(rows);
  const std::string motion = told(scene.read("motion", ""));
  CHECK_THAT(motion,
             Contains("phi.table: log.csv: value goes up to 4, ") && Contains("say unit: deg, or"));
  CHECK_THAT(motion, Contains("time spans 10000, ") && Contains("say time_unit: ms, or"));
  const std::string path = told(scene.read("reference", ""));
  CHECK_THAT(path, Contains("x goes up to 100, ") && Contains("say unit: mm or cm, or"));
  CHECK_THAT(path, Contains("time_unit: ms"));
  // A declared unit is believed; the other column still gives a warning.
  CHECK_THAT(told(scene.read("motion", ", unit: rad")), !Contains("degrees"));
  CHECK_THAT(told(scene.read("motion", ", unit: rad")), Contains("milliseconds"));
  CHECK_THAT(told(scene.read("motion", ", time_unit: s")), !Contains("milliseconds"));
  CHECK_THAT(told(scene.read("motion", ", time_unit: s")), Contains("degrees"));

  // Exactly at the thresholds there is no warning.
  const Scene plain("t,phi,x,y\n0,0,0,-1\n1,1.6,1,0\n2,-1.6,0,0\n100,0,0,0\n");
  CHECK(told(plain.read("motion", "")).empty());
  CHECK(told(plain.read("reference", "")).empty());
  const Scene beyond("t,phi,x,y\n0,0,0,-1.01\n1,1.61,1,0\n2,-1.6,0,0\n100.1,0,0,0\n");
  CHECK_THAT(told(beyond.read("motion", "")), Contains("degrees") && Contains("milliseconds"));
  CHECK_THAT(told(beyond.read("reference", "")), Contains("y goes up to 1.01"));
}

TEST_CASE("a clock's periods and a linkage's angles are read in their units") {
  const Folder folder;
  folder.put("periods.csv", "dt\n19\n21\n20\n");
  folder.put("curve.csv", "a,b\n-60,-20\n-20,-6\n20,6\n60,20\n");
  const auto read = [&](const std::string& of_periods, const std::string& of_curve) {
    return parse_scenario(
        "ball: {radius: 0.01}\n"
        "gimbal:\n"
        "  servo: {natural_frequency: 20, damping: 1}\n"
        "  linkage: {table: {file: curve.csv, servo: a, plate: b" +
            of_curve +
            "}}\n"
            "controller:\n"
            "  pd: {kv: 0, kp: 0}\n"
            "  drives: angle\n"
            "  assumes: exact\n"
            "  reference: {point: [0, 0]}\n"
            "  sampling: {period: 0.02, jitter: {file: periods.csv, period: dt" +
            of_periods +
            "}}\n"
            "time: {end: 10, step: 0.1}\n",
        folder / "scene.yaml");
  };
  for (const char* unit : {", unit: ms", ", time_unit: ms"}) {
    const Scenario scenario = read(unit, ", unit: deg");
    CHECK(scenario.controller->sampling->periods == std::vector<double>{0.019, 0.021, 0.02});
    CHECK(std::get<CurveLinkage>(*scenario.gimbal.linkage[1]).servo[3] ==
          Approx(std::numbers::pi / 3));
    CHECK(told(scenario).empty());
  }
  const std::string warned = told(read("", ""));
  CHECK_THAT(warned, Contains("controller.sampling.jitter: periods.csv: ") &&
                         Contains("looks like milliseconds; say unit: ms"));
  CHECK_THAT(warned, Contains("gimbal.linkage.table: curve.csv: an angle is 60, ") &&
                         Contains("looks like degrees; say unit: deg"));
}

TEST_CASE("log columns are checked for other units by their names") {
  CHECK(doubt_of(1.7, "phi")->looks_like == "degrees");
  CHECK_FALSE(doubt_of(1.6, "phi"));
  CHECK(doubt_of(1.1, "x_reference")->looks_like == "millimeters or centimeters");
  CHECK_FALSE(doubt_of(1, "x"));
  CHECK_FALSE(doubt_of(100, "gamma"));  // a ball may turn often
  CHECK_FALSE(doubt_of(100, "vx"));
  CHECK_FALSE(doubt_of(100, "phi_deg"));
  CHECK(largest_size({1, -3, std::nan(""), 2}) == 3);
}

}  // namespace bbsim_test::test_units
