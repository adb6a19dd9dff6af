// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Profiles of the gimbal angles.
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "support/folder.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_profile {

using namespace bbsim;
using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

std::string with_phi(const std::string& profile) {
  return "ball: {radius: 0.01}\ntime: {end: 10, step: 0.1}\ngimbal: {motion: {phi: " + profile +
         "}}\n";
}

Profile phi(const std::string& profile) {
  return parse(with_phi(profile)).gimbal.motion->phi;
}

std::string five_rows(const std::string& third) {
  return "t,a,b\n0,1,2\n2.5,2,3\n" + third + "\n7.5,4,5\n10,5,6\n";
}

}  // namespace

TEST_CASE("the shapes of a profile have units and defaults, and a list is their sum") {
  REQUIRE(phi("0.25").size() == 1);
  CHECK(std::get<double>(phi("0.25")[0]) == 0.25);
  CHECK(std::get<double>(phi("180 deg")[0]) == std::numbers::pi);
  const Profile sum =
      phi("[1, {sinusoid: {amplitude: 0.1, frequency: 0.5 Hz, phase: 1, offset: -2}}, "
          "{sinusoid: {amplitude: 0.1, frequency: 0}}, {ramp: {start: 1, rate: -2}}, "
          "{pulse: {start: 500 ms, duration: 100 ms, value: 2 deg}}]");
  REQUIRE(sum.size() == 5);
  CHECK(std::get<double>(sum[0]) == 1);
  const auto& all = std::get<Sinusoid>(sum[1]);
  CHECK(all.amplitude == 0.1);
  CHECK(all.frequency == std::numbers::pi);
  CHECK(all.phase == 1);
  CHECK(all.offset == -2);
  const auto& least = std::get<Sinusoid>(sum[2]);
  CHECK(least.phase == 0);
  CHECK(least.offset == 0);
  CHECK(std::get<Ramp>(sum[3]).start == 1);
  CHECK(std::get<Ramp>(sum[3]).rate == -2);
  const auto& pulse = std::get<Pulse>(sum[4]);
  CHECK(pulse.start == 0.5);
  CHECK(pulse.duration == 0.1);
  CHECK(pulse.value == Approx(2 * std::numbers::pi / 180));
}

TEST_CASE("a table is read relative to the scenario") {
  const Folder folder;
  folder.put("motion.csv", five_rows("5,3,4"));
  const std::string scenario =
      folder.put("scenario.yaml", with_phi("{table: {file: motion.csv, time: t, value: b}}"));
  const Scenario read = read_scenario(scenario);
  const auto& table = std::get<Table>(read.gimbal.motion->phi[0]);
  CHECK(table.file == "motion.csv");
  CHECK(table.times == std::vector<double>{0, 2.5, 5, 7.5, 10});
  CHECK(table.values == std::vector<double>{2, 3, 4, 5, 6});
}

TEST_CASE("a table is moved, scaled and delayed") {
  const Folder folder;
  folder.put("log.csv",
             "millis;mode;servo [deg]\n-1000;a;90\n4000;b;100\n9000;c;\n"
             "14000;d;110\n19000;e;120\n");
  const auto read = [&](const std::string& keys) {
    const std::string scenario =
        folder.put("scenario.yaml",
                   with_phi("{table: {file: log.csv, time: millis, time_unit: ms, value: servo, " +
                            keys + "}}"));
    return std::get<Table>(read_scenario(scenario).gimbal.motion->phi[0]);
  };
  constexpr double degree = std::numbers::pi / 180;
  const Table moved = read("time_offset: start, scale: -0.5, offset: 45 deg");
  CHECK(moved.times == std::vector<double>{0, 5, 15, 20});
  CHECK(moved.values[0] == Approx(0).margin(1e-15));
  CHECK(moved.values[3] == Approx(-15 * degree));
  CHECK(read("time_offset: 0.5").times == std::vector<double>{-0.5, 4.5, 14.5, 19.5});
  CHECK(read("unit: rad, offset: 1").values[1] == 101);
  CHECK(read("offset: 1").values[1] == Approx(101 * degree));
  CHECK(read("unit: deg, offset: 1").values[1] == Approx(101 * degree));
  const Table delayed = read("delay: 2 s");
  CHECK(delayed.times == std::vector<double>{-INFINITY, 1, 6, 16, 21, INFINITY});
  CHECK(delayed.values.front() == delayed.values[1]);
  CHECK(delayed.values.back() == delayed.values[4]);
}

TEST_CASE("a header may name the columns of a file without one") {
  const Folder folder;
  folder.put("log.csv", "0,1,2\n5,3,4\n10,5,6\n15,7,8\n");
  const std::string scenario = folder.put(
      "scenario.yaml", with_phi("{table: {file: log.csv, unit: rad, header: [t, a, b], time: t, "
                                "value: b}}"));
  const Scenario read = read_scenario(scenario);
  CHECK(std::get<Table>(read.gimbal.motion->phi[0]).values == std::vector<double>{2, 4, 6, 8});
}

TEST_CASE("a wrapping 32-bit clock drives a scene") {
  const Folder folder;
  folder.put("log.csv", "us,a\n4290000000,1\n4294000000,2\n32704,3\n9032704,4\n");
  const std::string scenario =
      folder.put("scenario.yaml",
                 with_phi("{table: {file: log.csv, time: us, value: a, unit: rad, time_unit: us, "
                          "time_offset: start}}"));
  const Scenario read = read_scenario(scenario);
  CHECK(std::get<Table>(read.gimbal.motion->phi[0]).times == std::vector<double>{0, 4, 5, 14});
}

TEST_CASE("a clock of milliseconds since an epoch drives a scene") {
  const Folder folder;
  folder.put("log.csv",
             "when,a\n1700000000000,1\n1700000001000,2\n1700000002000,3\n1700000015000,4\n");
  const auto read = [&](const std::string& unit) {
    const std::string scenario = folder.put(
        "scenario.yaml", with_phi("{table: {file: log.csv, time: when, value: a, unit: rad, "
                                  "time_offset: start" +
                                  unit + "}}"));
    return std::get<Table>(read_scenario(scenario).gimbal.motion->phi[0]).times;
  };
  CHECK(read("") == std::vector<double>{0, 1, 2, 15});
  CHECK_THROWS_AS(read(", time_unit: us"), InputError);  // 15 ms, shorter than the run
}

TEST_CASE("a clock of dates drives a scene, without its rows that lack one") {
  const Folder folder;
  folder.put("log.csv",
             "when,a\n2026-03-01 23:59:58,1\n2026-03-02 00:00:02,2\n,9\n"
             "2026-03-02 00:00:03,3\n2026-03-02 00:00:12,4\n");
  const std::string scenario = folder.put(
      "scenario.yaml", with_phi("{table: {file: log.csv, time: when, value: a, unit: rad}}"));
  const Scenario read = read_scenario(scenario);
  CHECK(std::get<Table>(read.gimbal.motion->phi[0]).times == std::vector<double>{0, 4, 5, 14});
}

TEST_CASE("a log's last row holds until the end, for one period of the log") {
  const Folder folder;
  folder.put("motion.csv", five_rows("5,3,4"));
  const std::string scenario = folder.put(
      "scenario.yaml", with_phi("{table: {file: motion.csv, time: t, value: b, unit: rad}}"));
  CHECK(read_scenario(scenario, {"time.end=9"}).remarks.empty());
  const Scenario held = read_scenario(scenario, {"time.end=11"});
  const auto& table = std::get<Table>(held.gimbal.motion->phi[0]);
  CHECK(table.times.back() == INFINITY);
  CHECK(table.values.back() == table.values[table.values.size() - 2]);
  REQUIRE_FALSE(held.remarks.empty());
  CHECK_THAT(held.remarks.front(), Contains("at 10 s, holds until time.end, 11 s"));
}

TEST_CASE("the tables read are reported under the scenario's names") {
  const Folder folder;
  const std::string table = "t,angle,other\n0,0,1\n1,0.1,2\n2,0,3\n3,0.1,4\n";
  folder.put("a.csv", table);
  folder.put("b.csv", table);
  const std::string text =
      "ball: {radius: 0.01}\n"
      "time: {end: 3, step: 1}\n"
      "gimbal: {motion: {phi: {table: {file: a.csv, time: t, value: angle}},\n"
      "                  theta: [{table: {file: ./b.csv, time: t, value: angle}},\n"
      "                          {table: {file: a.csv, time: t, value: other}}]}}\n";
  std::vector<file::InputTable> inputs;
  static_cast<void>(parse_scenario(text, folder / "scene.yaml", {}, &inputs));
  REQUIRE(inputs.size() == 2);
  CHECK(inputs[0].file == "./b.csv");
  CHECK(inputs[1].file == "a.csv");
  CHECK(inputs[1].data->names() == std::vector<std::string>{"t", "angle", "other"});
  CHECK(inputs[1].data->columns[2].numbers == std::vector<double>{1, 2, 3, 4});
}

}  // namespace bbsim_test::test_profile
