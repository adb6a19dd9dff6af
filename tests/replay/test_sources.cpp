// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes from scenarios, tables and sweeps.
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "catch.hpp"
#include "replay/scene.hpp"
#include "replay/sources.hpp"
#include "results/result.hpp"
#include "scenario/reader.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_sources {

using namespace bbsim;
using namespace bbsim::replay;

namespace {

std::string config(const std::string& name) {
  std::string file = BBSIM_SOURCE_DIR "/configs/";
  return file.append(name).append(".yaml");
}

Run described(const std::string& name) {
  Run run;
  describe(run, read_scenario(config(name)));
  return run;
}

// The summary of r.csv, which an event stopped.
std::string summary(const std::string& more, double t, const std::string& place) {
  return R"({"version": "7", "status": "stopped", "output": "r.csv", "scenario_text": "", )" +
         more + R"(, "events": [{"event": "edge", "action": "stop", "t": )" + std::to_string(t) +
         place + "}]}";
}

replay::Sweep sweep_of_table(const std::string& table) {
  const Folder folder;
  return sweep_of_result(results::read_result(folder.put("s.csv", table), {}), "s.csv");
}

}  // namespace

TEST_CASE("a scenario determines what a replay shows") {
  const Run rig = described("rig");
  CHECK(rig.title == "A hobby rig on the circle of Fig. 2(b)");
  CHECK(rig.scenario->plate.size == std::array<double, 2>{0.32, 0.24});
  CHECK(ball_radius(rig) == 0.02);
  CHECK(rig.scenario->events.slip->friction == 0.3);
  CHECK(rig.scenario->time.end == 40);
  REQUIRE(rig.poles);
  CHECK(rig.poles->period == 0.02);
  CHECK(rig.poles->values.size() == 16);
  CHECK(rig.scenario->source.text.find("A hobby rig") != std::string::npos);
  // One closed lap of the circle.
  REQUIRE(rig.reference.size() > 100);
  CHECK(rig.reference.front()[0] == Approx(rig.reference.back()[0]));
  for (const auto& point : rig.reference) CHECK(std::hypot(point[0], point[1]) == Approx(0.05));

  const Run open = described("fig2a");
  CHECK_FALSE(open.poles);
  CHECK(open.reference.empty());
  CHECK_FALSE(open.scenario->plate.size);
  const Run point = described("falls");
  CHECK(point.reference.size() == 1);
  const Run continuous = described("fig2b");
  REQUIRE(continuous.poles);
  CHECK_FALSE(continuous.poles->period);
  CHECK(continuous.poles->values.size() == 8);
}

TEST_CASE("a table's columns have their units") {
  const Run run = run_of_table({{"t", "x", "phi", "mine"}, {{0, 1}, {0, 1}, {0, 1}, {0, 1}}}, "a");
  CHECK(run.find("x")->unit == "m");
  CHECK(run.find("phi")->unit == "rad");
  CHECK(run.find("mine")->unit.empty());
  CHECK(row_count(run) == 2);
}

TEST_CASE("neither units nor turns are assumed for a table of unknown origin") {
  const Folder folder;
  const std::string file = folder.put("log.csv", "t,x,y,gamma\n0,-12,3,0\n1,-11,3,0\n");
  const Run run = run_of_result(results::read_result(file, {}), "log.csv");
  CHECK_FALSE(run.units_known);
  for (const file::Column& series : run.columns) CHECK(series.unit.empty());
  CHECK_FALSE(run.rolls);
  CHECK(orientation_of(run, 0.01).empty());
  // Its scenario gives both.
  results::Result told = results::read_result(file, {"", config("fig2a"), {}});
  const Scenario scenario = *told.scenario;
  Run known = run_of_result(std::move(told), "log.csv");
  describe(known, scenario);
  CHECK(known.find("x")->unit == "m");
  CHECK(known.rolls);
  CHECK(orientation_of(known, 0.01).size() == 2);
  // But neither rolling of a ball that may slide, nor pivoting if it is not recorded.
  Run sliding = known;
  describe(sliding, read_scenario(config("slides")));
  CHECK_FALSE(sliding.rolls);
  CHECK(orientation_of(sliding, 0.01).empty());
  const std::string bare = folder.put("bare.csv", "t,x,y\n0,0,0\n1,1,0\n");
  CHECK_FALSE(
      run_of_result(results::read_result(bare, {"", config("fig2a"), {}}), "bare.csv").rolls);
}

TEST_CASE("commands have the unit of their target") {
  const auto unit = [](const char* scene) {
    Run run = run_of_table({{"t", "x", "phi_command"}, {{0, 1}, {0, 1}, {0, 1}}}, "a");
    describe_sight(run, read_scenario(config(scene)));
    return run.find("phi_command")->unit;
  };
  CHECK(unit("rig") == "rad");
  CHECK(unit("fig2b-literal") == "rad/s^2");
  CHECK(unit("torque-lqr") == "N m");
}

TEST_CASE(
    "the instant at which an event stops a run is its last row, and the ball rolls up to it") {
  const Folder folder;
  const std::string file = folder.put("r.csv",
                                      "t,x,y,ball_qw,ball_qx,ball_qy,ball_qz,phi\n"
                                      "0,0,0,1,0,0,0,0\n1,0.1,0,1,0,0,0,0\n");
  folder.put("r.json", summary(R"("title": "", "reason": "", "end_time": 1.5, "rows": 2)", 1.5,
                               R"(, "x": 0.11, "y": 0.0, "phi": 0.3)"));
  results::Result result = results::read_result(file, {"", config("fig2a"), {}});
  const Scenario scenario = *result.scenario;
  Run run = run_of_result(std::move(result), "r.csv");
  CHECK(run.has_end_row);
  CHECK(row_count(run) == 3);
  CHECK(rows_of_file(run) == 2);
  CHECK(run.end_time == 1.5);
  CHECK(run.find("x")->numbers.back() == 0.11);
  CHECK(run.find("phi")->numbers.back() == 0.3);
  run.rolls = true;
  describe_sight(run, scenario);
  // One centimeter with a radius of one: one radian about y.
  CHECK(run.orientation.back()[0] == Approx(std::cos(0.5)));
  CHECK(run.orientation.back()[2] == Approx(std::sin(0.5)));
}

TEST_CASE("a sweep's table: keys, status and measures") {
  const replay::Sweep sweep = sweep_of_table(
      "case,ball.radius,solver.method,status,reason,end_time,max_tilt,end_x\n"
      "0,0.01,radau,done,,10,0.1,0.5\n"
      "1,0.02,bdf,failed,\"it grew, \"\"fast\"\"\",0.7,nan,1\n");
  CHECK(sweep.name == "s.csv");
  CHECK(sweep.cases == std::vector<double>{0, 1});
  REQUIRE(sweep.keys.size() == 2);
  CHECK(sweep.keys[0].numbers == std::vector<double>{0.01, 0.02});
  CHECK(sweep.keys[1].texts == std::vector<std::string>{"radau", "bdf"});
  CHECK(sweep.status[0] == "done");
  CHECK(sweep.status[1] == "failed: it grew, \"fast\"");
  REQUIRE(sweep.measures.size() == 3);
  CHECK(sweep.measures[0].name == "max_tilt");
  CHECK(sweep.measures[0].unit == "rad");
  CHECK(std::isnan(sweep.measures[0].numbers[1]));
  CHECK(sweep.measures[1].unit == "m");
  CHECK(sweep.measures[2].name == "end_time");
  CHECK(sweep.measures[2].unit == "s");
}

TEST_CASE("a sweep's keys: which are tied and which are random") {
  std::string table = "case,a,b,c,status,max_tilt\n";
  const char* const drawn[] = {"3", "1", "7", "2", "9", "4", "6", "5"};
  for (int i = 0; i < 8; ++i) {
    const int a = i / 4;
    table += std::to_string(i) + ',' + std::to_string(a) + ',' + std::to_string(-2 * a) + ',' +
             drawn[i] + ",done,1\n";
  }
  const replay::Sweep sweep = sweep_of_table(table);
  REQUIRE(sweep.keys.size() == 3);
  CHECK(sweep.keys[0].along.empty());
  CHECK(sweep.keys[1].along == "a");
  CHECK(sweep.keys[2].along.empty());
  CHECK_FALSE(sweep.keys[0].drawn);
  CHECK(sweep.keys[2].drawn);
}

TEST_CASE("a result includes its summary's data and the ball's orientation") {
  const Folder folder;
  const std::string file = folder.put("r.csv",
                                      "t,x,y,ball_qw,ball_qx,ball_qy,ball_qz\n"
                                      "0,0,0,1,0,0,0\n1,1,2,0,0,2,0\n2,1,2,nan,nan,nan,nan\n");
  folder.put("r.json",
             summary(R"("title": "A title", "reason": "it fell", "end_time": 1, "rows": 3)", 0.5,
                     R"(, "x": 0.1, "y": 0.2)"));
  const Run run = run_of_result(results::read_result(file, {}), "r.csv");
  CHECK(run.title == "A title");
  CHECK(run.status == "stopped");
  CHECK(run.reason == "it fell");
  CHECK(run.version == "7");
  CHECK(run.summary.find("scenario_text") == std::string::npos);
  CHECK(run.summary.find("it fell") != std::string::npos);
  REQUIRE(run.events.size() == 1);
  CHECK(run.events[0].stopped);
  CHECK(run.columns.size() == 3);
  REQUIRE(run.orientation.size() == 3);
  CHECK(run.orientation[1] == Quaternion{0, 0, 1, 0});
  CHECK(run.orientation[2] == run.orientation[1]);  // unknown, so the last one is kept
}

}  // namespace bbsim_test::test_sources
