// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Profiles of the gimbal angles.
#include <cmath>
#include <numbers>

#include "catch.hpp"
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

TEST_CASE("a number is a constant") {
  REQUIRE(phi("0.25").size() == 1);
  CHECK(std::get<double>(phi("0.25")[0]) == 0.25);
  CHECK(std::get<double>(phi("180 deg")[0]) == std::numbers::pi);
}

TEST_CASE("a sinusoid") {
  const auto all = std::get<Sinusoid>(
      phi("{sinusoid: {amplitude: 0.1, frequency: 0.5 Hz, phase: 1, offset: -2}}")[0]);
  CHECK(all.amplitude == 0.1);
  CHECK(all.frequency == std::numbers::pi);
  CHECK(all.phase == 1);
  CHECK(all.offset == -2);
  const auto least = std::get<Sinusoid>(phi("{sinusoid: {amplitude: 0.1, frequency: 0}}")[0]);
  CHECK(least.phase == 0);
  CHECK(least.offset == 0);
  CHECK_THAT(errors(with_phi("{sinusoid: {}}")),
             Contains("phi.sinusoid.amplitude: missing; allowed: an angle") &&
                 Contains("phi.sinusoid.frequency: missing; allowed: an angular rate"));
}

TEST_CASE("a ramp") {
  const auto ramp = std::get<Ramp>(phi("{ramp: {start: 1, rate: -2}}")[0]);
  CHECK(ramp.start == 1);
  CHECK(ramp.rate == -2);
  CHECK_THAT(errors(with_phi("{ramp: {start: 1}}")), Contains("phi.ramp.rate: missing"));
}

TEST_CASE("a pulse") {
  const Profile profile = phi("{pulse: {start: 500 ms, duration: 100 ms, value: 2 deg}}");
  const auto& pulse = std::get<Pulse>(profile.at(0));
  CHECK(pulse.start == 0.5);
  CHECK(pulse.duration == 0.1);
  CHECK(pulse.value == Approx(2 * std::numbers::pi / 180));
  CHECK_THAT(errors(with_phi("{pulse: {start: 1, duration: 0, value: 1}}")),
             Contains("phi.pulse.duration: found 0; allowed: a time greater than 0"));
  CHECK_THAT(errors(with_phi("{pulse: {start: 1, duration: 1}}")),
             Contains("phi.pulse.value: missing"));
}

TEST_CASE("a list is a sum") {
  const Profile sum =
      phi("[1, {ramp: {start: 0, rate: 1}}, {sinusoid: {amplitude: 1, "
          "frequency: 1}}]");
  REQUIRE(sum.size() == 3);
  CHECK(std::get<double>(sum[0]) == 1);
  CHECK(std::get<Ramp>(sum[1]).rate == 1);
  CHECK(std::get<Sinusoid>(sum[2]).amplitude == 1);
  CHECK(errors(with_phi("[1, [2]]")) ==
        "scenario.yaml:3:28: gimbal.motion.phi.1: found a list of 1; allowed: an angle, such as "
        "0.1 or \"4 deg\", or one of sinusoid, ramp, pulse, table");
  CHECK_THAT(errors(with_phi("[]")), Contains("found an empty list; allowed: a list of 1 to 1000"));
}

TEST_CASE("a term is exactly one of the shapes") {
  CHECK(errors(with_phi("{}")) ==
        "scenario.yaml:3:19: gimbal.motion.phi: found none; allowed: exactly one of sinusoid, "
        "ramp, pulse, table");
  CHECK_THAT(errors(with_phi("{ramp: {start: 0, rate: 1}, table: {}}")),
             Contains("phi: found ramp, table; allowed: exactly one of"));
  CHECK_THAT(errors(with_phi("[{sinus: {}}]")),
             Contains("phi.0.sinus: unknown key; did you mean gimbal.motion.phi.0.sinusoid?"));
  CHECK_THAT(errors(with_phi("")), Contains("phi: found nothing; allowed: an angle") &&
                                       Contains("or a list of these: their sum"));
}

TEST_CASE("a table is read relative to the scenario") {
  const TemporaryFolder folder;
  static_cast<void>(folder.write("motion.csv", five_rows("5,3,4")));
  const std::string scenario =
      folder.write("scenario.yaml", with_phi("{table: {file: motion.csv, time: t, value: b}}"));
  const Scenario read = read_scenario(scenario);
  const auto& table = std::get<Table>(read.gimbal.motion->phi[0]);
  CHECK(table.file == "motion.csv");
  CHECK(table.times == std::vector<double>{0, 2.5, 5, 7.5, 10});
  CHECK(table.values == std::vector<double>{2, 3, 4, 5, 6});
}

TEST_CASE("a table must be usable") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& rows, const std::string& table) {
    static_cast<void>(folder.write("motion.csv", rows));
    const std::string scenario = folder.write("scenario.yaml", with_phi("{table: " + table + "}"));
    try {
      static_cast<void>(read_scenario(scenario));
      return std::string();
    } catch (const InputError& e) {
      REQUIRE(e.problems().size() == 1);
      CHECK(e.problems()[0].where.starts_with(scenario + ":3:"));
      return e.problems()[0].message;
    }
  };
  const std::string good = "{file: motion.csv, time: t, value: a}";
  const std::string key = "gimbal.motion.phi.table: motion.csv: ";
  CHECK(refused(five_rows("5,3,4"), good).empty());
  CHECK(refused("t,a\n0,1\n5,2\n10,3\n", good) == key + "found 3 rows; allowed: at least 4");
  CHECK(refused(five_rows("2.5,3,4"), good) ==
        key +
            "found the time 2.5 in row 3 below the header, after 2.5; allowed: strictly "
            "increasing times; remove one of the two rows");
  CHECK(refused("t,a\n0,1\n1,1\n2,1\n9,1\n", good) ==
        key + "found times from 0 to 9 s; allowed: a table that covers the run, 0 to 10 s");
  CHECK(refused("t,a\n1,1\n2,1\n3,1\n11,1\n", good) ==
        key +
            "found times from 1 to 11 s; allowed: a table that covers the run, 0 to 10 s; "
            "time_offset: start makes its first row t = 0");
  CHECK(refused(five_rows("5,3,4"), "{file: motion.csv, time: time, value: a}") ==
        "gimbal.motion.phi.table.time: found time; allowed: one of t, a, b");
  CHECK_THAT(refused(five_rows("5,3,4"), "{file: absent.csv, time: t, value: a}"),
             Contains("gimbal.motion.phi.table.file: "));
  CHECK(
      refused(five_rows("5,3,4"), "{file: ., time: t, value: a}") ==
      "gimbal.motion.phi.table.file: found ., which is not a regular file; allowed: a table file");
  CHECK_THAT(refused(five_rows("5,3,4"), "{file: motion.csv, time: t}"),
             Contains("gimbal.motion.phi.table.value: missing"));
}

TEST_CASE("a table is moved, scaled and delayed") {
  const TemporaryFolder folder;
  static_cast<void>(folder.write("log.csv",
                                 "millis;mode;servo [deg]\n-1000;a;90\n4000;b;100\n9000;c;\n"
                                 "14000;d;110\n19000;e;120\n"));
  const auto read = [&](const std::string& keys) {
    const std::string scenario = folder.write(
        "scenario.yaml",
        with_phi("{table: {file: log.csv, time: millis, time_unit: ms, value: servo, " + keys +
                 "}}"));
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

TEST_CASE("a table's header names the columns of a file without one") {
  const TemporaryFolder folder;
  static_cast<void>(folder.write("log.csv", "0,1,2\n5,3,4\n10,5,6\n15,7,8\n"));
  const auto file = [&](const std::string& phi, const std::string& theta) {
    return folder.write("scenario.yaml",
                        "ball: {radius: 0.01}\ntime: {end: 10, step: 0.1}\n"
                        "gimbal:\n  motion:\n    phi: {table: {" +
                            phi + "}}\n    theta: {table: {" + theta + "}}\n");
  };
  const std::string named = "file: log.csv, unit: rad, header: [t, a, b], time: t, value: ";
  const Scenario read = read_scenario(file(named + "a", named + "b"));
  CHECK(std::get<Table>(read.gimbal.motion->theta[0]).values == std::vector<double>{2, 4, 6, 8});
  CHECK_THROWS_WITH(
      read_scenario(file(named + "a", "file: log.csv, header: [t, a, c], time: t, value: c")),
      Contains("scenario.yaml:6:") &&
          Contains("theta.table.header: found other names than where log.csv is read first"));
  CHECK_THROWS_WITH(
      read_scenario(file("file: log.csv, header: [t, t], time: t, value: t", named + "b")),
      Contains("phi.table.header.1: found t again; allowed: each name once"));
}

TEST_CASE("a time twice in a table, or a falling one, is refused with row and cure") {
  const TemporaryFolder folder;
  const std::string scenario =
      folder.write("scenario.yaml", with_phi("{table: {file: log.csv, time: t, value: a}}"));
  static_cast<void>(folder.write("log.csv", "t,a\n0,1\n5,1\n5,1\n10,1\n"));
  CHECK_THROWS_WITH(
      read_scenario(scenario),
      Contains("found the time 5 in row 3 below the header, after 5; allowed: strictly "
               "increasing times; remove one of the two rows"));
  static_cast<void>(folder.write("log.csv", "t,a\n0,1\n6,1\n5,1\n10,1\n"));
  CHECK_THROWS_WITH(read_scenario(scenario),
                    Contains("in row 3") && Contains("sort the rows by time"));
}

TEST_CASE("a wrapping 32-bit clock drives a scene") {
  const TemporaryFolder folder;
  static_cast<void>(
      folder.write("log.csv", "us,a\n4290000000,1\n4294000000,2\n32704,3\n9032704,4\n"));
  const std::string scenario =
      folder.write("scenario.yaml",
                   with_phi("{table: {file: log.csv, time: us, value: a, unit: rad, time_unit: us, "
                            "time_offset: start}}"));
  const Scenario read = read_scenario(scenario);
  CHECK(std::get<Table>(read.gimbal.motion->phi[0]).times == std::vector<double>{0, 4, 5, 14});
}

TEST_CASE("a table must cover a run that an override lengthens") {
  const TemporaryFolder folder;
  static_cast<void>(folder.write("motion.csv", five_rows("5,3,4")));
  const std::string scenario =
      folder.write("scenario.yaml", with_phi("{table: {file: motion.csv, time: t, value: b}}"));
  CHECK(read_scenario(scenario, {"time.end=9"}).time.end == 9);
  CHECK_THROWS_WITH(read_scenario(scenario, {"time.end=13"}),
                    Contains("found times from 0 to 10 s; allowed: a table that covers the run, 0 "
                             "to 13 s"));
  // A log ends with the last sample before the end.
  const Scenario held = read_scenario(scenario, {"time.end=11"});
  const auto& table = std::get<Table>(held.gimbal.motion->phi[0]);
  CHECK(table.times.back() == INFINITY);
  CHECK(table.values.back() == table.values[table.values.size() - 2]);
  REQUIRE_FALSE(held.remarks.empty());
  CHECK_THAT(held.remarks.front(),
             Contains("note: ") && Contains("its last row, at 10 s, holds until time.end, 11 s"));
}

TEST_CASE("the tables read are reported under the scenario's names") {
  const TemporaryFolder folder;
  const std::string table = "t,angle,other\n0,0,1\n1,0.1,2\n2,0,3\n3,0.1,4\n";
  static_cast<void>(folder.write("a.csv", table));
  static_cast<void>(folder.write("b.csv", table));
  const std::string text =
      "ball: {radius: 0.01}\n"
      "time: {end: 3, step: 1}\n"
      "gimbal: {motion: {phi: {table: {file: a.csv, time: t, value: angle}},\n"
      "                  theta: [{table: {file: ./b.csv, time: t, value: angle}},\n"
      "                          {table: {file: a.csv, time: t, value: other}}]}}\n";
  std::vector<file::InputTable> inputs;
  static_cast<void>(parse_scenario(text, folder.file("scene.yaml"), {}, &inputs));
  REQUIRE(inputs.size() == 2);
  CHECK(inputs[0].file == "./b.csv");
  CHECK(inputs[1].file == "a.csv");
  CHECK(inputs[1].data->names == std::vector<std::string>{"t", "angle", "other"});
  CHECK(inputs[1].data->columns[2] == std::vector<double>{1, 2, 3, 4});
}

TEST_CASE("a table's column names are shown safe for a terminal") {
  const TemporaryFolder folder;
  static_cast<void>(folder.write("a.csv", "t,x\u009b2J\n0,0\n1,1\n2,2\n3,3\n"));
  const std::string text =
      "ball: {radius: 0.01}\n"
      "time: {end: 3, step: 1}\n"
      "gimbal: {motion: {phi: {table: {file: a.csv, time: t, value: y}}}}\n";
  std::string message;
  try {
    static_cast<void>(parse_scenario(text, folder.file("scene.yaml")));
  } catch (const InputError& error) {
    message = error.what();
  }
  CHECK_THAT(message, Contains("one of t, x\\u009b2J"));
}

}  // namespace bbsim_test::test_profile
