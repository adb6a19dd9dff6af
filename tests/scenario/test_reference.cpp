// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reference paths of a controller.
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_reference {

using namespace bbsim;
using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

const std::string key = "controller.reference";

template <class Kind>
Kind read_as(const std::string& reference) {
  const Scenario scenario = parse(closed_loop, {key + "=" + reference});
  return std::get<Kind>(scenario.controller->reference);
}

// The problems of a reference without their place, which is the override.
std::string problem(const std::string& reference) {
  const std::string place = "--set " + key + "=" + reference + ": ";
  const std::string text = errors(closed_loop, {key + "=" + reference});
  return text.starts_with(place) ? text.substr(place.size()) : text;
}

const std::string lissajous = key + ".lissajous.";
const std::string waypoints = key + ".waypoints.";

std::string way(const std::string& points, const std::string& times) {
  return "{waypoints: {points: " + points + ", times: " + times + "}}";
}

}  // namespace

TEST_CASE("a reference is exactly one of the known paths") {
  const std::string allowed =
      "; allowed: exactly one of circle, point, lissajous, waypoints, table, step, square, "
      "staircase";
  CHECK(problem("{}") == key + ": found none" + allowed);
  CHECK(problem("{circle: {radius: 1, rate: 1}, point: [0, 0]}") ==
        key + ": found circle, point" + allowed);
  CHECK(problem("{point: [0, 0], table: {}}").starts_with(key + ": found point, table" + allowed));
  CHECK_THAT(problem("{lissajou: {amplitude: [1, 1], rate: [1, 1]}}"),
             Contains(key + ".lissajou: unknown key; did you mean " + key + ".lissajous?"));
}

TEST_CASE("a point") {
  CHECK(read_as<PointReference>("{point: [1 cm, -2]}").position == Pair{0.01, -2});
  CHECK(problem("{point: 1}") ==
        key + ".point: found 1; allowed: two lengths [x, y], such as [0.1, 0]");
}

TEST_CASE("a circle's center is the origin by default") {
  const auto circle = read_as<CircleReference>("{circle: {radius: 0, rate: -0.3, phase: 1}}");
  CHECK(circle.radius == 0);
  CHECK(circle.rate == -0.3);
  CHECK(circle.phase == 1);
  CHECK(circle.centre == Pair{0, 0});
  CHECK(read_as<CircleReference>("{circle: {radius: 1, rate: 1, centre: [2 cm, 3]}}").centre ==
        Pair{0.02, 3});
  CHECK_THAT(problem("{circle: {radius: -1}}"),
             Contains("circle.radius: found -1; allowed: a length of at least 0") &&
                 Contains("circle.rate: missing"));
  CHECK(problem("{circle: {radius: 1, rate: 1, centter: [0, 0]}}") ==
        key + ".circle.centter: unknown key; did you mean " + key + ".circle.center?");
  CHECK(problem("{circle: {radius: 1, rate: 1, centre: 2}}") ==
        key + ".circle.centre: found 2; allowed: two lengths [x, y], such as [0.1, 0]");
}

TEST_CASE("a Lissajous figure, with units and defaults") {
  const auto all = read_as<LissajousReference>(
      "{lissajous: {amplitude: [5 cm, -0.03], rate: [0.5 Hz, 2], phase: [90 deg, 1], "
      "centre: [1 cm, 2 mm]}}");
  CHECK(all.amplitude == Pair{0.05, -0.03});
  CHECK(all.rate == Pair{std::numbers::pi, 2});
  CHECK(all.phase == Pair{std::numbers::pi / 2, 1});
  CHECK(all.centre == Pair{0.01, 0.002});
  const auto least = read_as<LissajousReference>("{lissajous: {amplitude: [1, 1], rate: [1, 0]}}");
  CHECK(least.phase == Pair{0, 0});
  CHECK(least.centre == Pair{0, 0});

  CHECK(problem("{lissajous: {amplitude: [1, 1]}}") ==
        lissajous + "rate: missing; allowed: two angular rates [x, y], such as [0.1, 0]");
  CHECK(problem("{lissajous: {amplitude: 1, rate: [1, 1]}}") ==
        lissajous + "amplitude: found 1; allowed: two lengths [x, y], such as [0.1, 0]");
  CHECK(problem("{lissajous: {amplitude: [1, 1], rate: [1, 2 s]}}") ==
        lissajous + "rate.1: found 2 s, a time; allowed: an angular rate, such as 3 or \"0.5 Hz\"");
  CHECK(problem("{lissajous: {amplitude: [1, 1], rate: [1, 2], radius: 3}}") ==
        lissajous + "radius: unknown key; known keys here: amplitude, rate, phase, center");
}

TEST_CASE("waypoints, with units and defaults") {
  const auto way_through = read_as<WaypointReference>(
      "{waypoints: {points: [[0, 0], [5 cm, 0.02], [1, 1]], times: [-1, 500 ms, 2]}}");
  CHECK(way_through.points == std::vector<Pair>{{0, 0}, {0.05, 0.02}, {1, 1}});
  CHECK(way_through.times == std::vector<double>{-1, 0.5, 2});
  CHECK_FALSE(way_through.rest);
  const std::string rest = "{waypoints: {points: [[0, 0], [1, 1]], times: [0, 1], rest: ";
  CHECK(read_as<WaypointReference>(rest + "true}}").rest);
  CHECK_FALSE(read_as<WaypointReference>(rest + "false}}").rest);
  CHECK(problem(rest + "yes}}") == waypoints + "rest: found yes; allowed: one of true, false");
}

TEST_CASE("waypoints that form no path are refused") {
  const std::string points = "; allowed: a list of 2 to 10000 points [x, y]";
  const std::string times = "; allowed: a list of 2 to 10000 times, one for each point";
  CHECK(problem(way("[[0, 0]]", "[0, 1]")) == waypoints + "points: found a list of 1" + points);
  CHECK(problem(way("1", "[0, 1]")) == waypoints + "points: found 1" + points);
  CHECK(problem(way("[[0, 0], [1, 1]]", "3")) == waypoints + "times: found 3" + times);
  CHECK(problem("{waypoints: {points: [[0, 0], [1, 1]]}}") ==
        waypoints + "times: missing; allowed: a list of 2 to 10000 times, one for each point");
  CHECK(problem(way("[[0, 0], 1]", "[0, 1]")) ==
        waypoints + "points.1: found 1; allowed: two lengths [x, y], such as [0.1, 0]");
  CHECK(problem(way("[[0, 0], [1, 2 s]]", "[0, 1]")) ==
        waypoints + "points.1.1: found 2 s, a time; allowed: a length, such as 0.01 or \"1 cm\"");
  CHECK(problem(way("[[0, 0], [1, 1], [2, 2]]", "[0, 1]")) ==
        waypoints + "times: found 2 times for 3 points; allowed: one time for each point");
  CHECK(problem(way("[[0, 0], [1, 1], [2, 2]]", "[0, 2 s, 2000 ms]")) ==
        waypoints + "times.2: found 2000 ms, after 2 s; allowed: strictly increasing times");
  CHECK(problem(way("[[0, 0], [1, 1]]", "[0, .inf]")) ==
        waypoints +
            "times.1: found .inf, which is not finite; allowed: a time, such as 0.02 or "
            "\"20 ms\"");
}

TEST_CASE("a reference table is read relative to the scenario") {
  const TemporaryFolder folder;
  const auto scenario = [&](const std::string& table) {
    return folder.write("scenario.yaml",
                        "ball: {radius: 0.01}\n"
                        "time: {end: 10, step: 0.1}\n"
                        "controller:\n"
                        "  pd: {kv: 100, kp: 0.1}\n"
                        "  reference: {table: " +
                            table + "}\n");
  };
  const auto refused = [&](const std::string& rows, const std::string& table) {
    static_cast<void>(folder.write("path.csv", rows));
    const std::string file = scenario(table);
    try {
      static_cast<void>(read_scenario(file));
      return std::string();
    } catch (const InputError& e) {
      REQUIRE(e.problems().size() == 1);
      CHECK(e.problems()[0].where.starts_with(file + ":5:"));
      return e.problems()[0].message;
    }
  };
  const std::string good = "{file: path.csv, time: t, x: a, y: b}";
  const std::string rows = "t,a,b\n0,1,2\n2.5,2,3\n5,3,4\n10,5,6\n";
  const std::string place = key + ".table: path.csv: ";
  REQUIRE(refused(rows, good).empty());
  const Scenario read = read_scenario(scenario(good));
  const auto& table = std::get<TableReference>(read.controller->reference);
  CHECK(table.file == "path.csv");
  CHECK(table.times == std::vector<double>{0, 2.5, 5, 10});
  CHECK(table.x == std::vector<double>{1, 2, 3, 5});
  CHECK(table.y == std::vector<double>{2, 3, 4, 6});

  CHECK(refused("t,a,b\n0,1,1\n5,2,1\n10,3,1\n", good) ==
        place + "found 3 rows; allowed: at least 4");
  CHECK(refused("t,a,b\n0,1,1\n2,1,1\n2,1,1\n9,1,1\n", good) ==
        place +
            "found the time 2 in row 3 below the header, after 2; allowed: strictly increasing "
            "times; remove one of the two rows");
  CHECK(refused("t,a,b\n0,1,1\n1,1,1\n2,1,1\n9,1,1\n", good) ==
        place + "found times from 0 to 9 s; allowed: a table that covers the run, 0 to 10 s");
  CHECK(refused("t,a,b\n0,1,1\n1,1,nan\n2,1,1\n10,1,1\n", good) ==
        place + "found the y nan in row 2 below the header; allowed: a finite length");
  CHECK(refused(rows, "{file: path.csv, time: t, x: a, y: c}") ==
        key + ".table.y: found c; allowed: one of t, a, b");
  CHECK(refused(rows, "{file: path.csv, time: t, x: a}") ==
        key + ".table.y: missing; allowed: the name of a column of the file");
  CHECK(refused(rows, "{file: path.csv, time: t, x: a, y: b, value: c}") ==
        key +
            ".table.value: unknown key; known keys here: file, time, x, y, header, "
            "unit, time_unit, scale, offset, delay, time_offset");
}

TEST_CASE("a step starts at the origin at t = 0 unless given otherwise") {
  const auto all = read_as<StaircaseReference>("{step: {from: [1 cm, 0], to: [0, 2 cm], at: 3 s}}");
  CHECK(all.points == std::vector<Pair>{{0.01, 0}, {0, 0.02}});
  CHECK(all.jumps == std::vector<double>{3});
  const auto least = read_as<StaircaseReference>("{step: {to: [1, 2]}}");
  CHECK(least.points == std::vector<Pair>{{0, 0}, {1, 2}});
  CHECK(least.jumps == std::vector<double>{0});

  const std::string step = key + ".step.";
  CHECK(problem("{step: {at: 1}}") ==
        step + "to: missing; allowed: two lengths [x, y], such as [0.1, 0]");
  CHECK_THAT(problem("{step: {to: [1, 2], at: -1}}"), Contains(step + "at: found -1; allowed: "));
  CHECK_THAT(problem("{step: {to: 1}}"), Contains(step + "to: found 1; allowed: two lengths"));
  CHECK(problem("{step: {to: [1, 1], time: 2}}") ==
        step + "time: unknown key; known keys here: from, to, at");
}

TEST_CASE("a square wave has one period, and an amplitude and phase per axis") {
  const auto all = read_as<SquareReference>(
      "{square: {amplitude: [5 cm, -0.03], period: 500 ms, phase: [0, 90 deg], center: [0, 1 cm], "
      "duty: 0.25}}");
  CHECK(all.amplitude == Pair{0.05, -0.03});
  CHECK(all.period == 0.5);
  CHECK(all.phase == Pair{0, std::numbers::pi / 2});
  CHECK(all.centre == Pair{0, 0.01});
  CHECK(all.duty == 0.25);
  const auto least = read_as<SquareReference>("{square: {amplitude: [1, 0], period: 1}}");
  CHECK(least.phase == Pair{0, 0});
  CHECK(least.centre == Pair{0, 0});
  CHECK(least.duty == 0.5);

  const std::string square = key + ".square.";
  CHECK_THAT(problem("{square: {amplitude: [1, 1]}}"), Contains(square + "period: missing"));
  CHECK_THAT(problem("{square: {amplitude: [1, 1], period: 0}}"),
             Contains(square + "period: found 0; allowed: "));
  CHECK_THAT(problem("{square: {amplitude: [1, 1], period: 1, duty: 1}}"),
             Contains(square + "duty: found 1; allowed: "));
  CHECK_THAT(problem("{square: {amplitude: [1, 1], period: 1 us}}"),
             Contains(square + "period: found more than 100,000 jumps until time.end; allowed: a "
                               "longer period"));
}

TEST_CASE("a staircase holds each point from its time on") {
  const auto stairs = read_as<StaircaseReference>(
      "{staircase: {points: [[0, 0], [1 cm, 0], [0, 2 cm]], times: [0, 1, 2500 ms]}}");
  CHECK(stairs.points == std::vector<Pair>{{0, 0}, {0.01, 0}, {0, 0.02}});
  CHECK(stairs.jumps == std::vector<double>{1, 2.5});

  const std::string staircase = key + ".staircase.";
  CHECK(problem("{staircase: {points: [[0, 0], [1, 0]], times: [0]}}") ==
        staircase +
            "times: found a list of 1; allowed: a list of 2 to 10000 times, one for each point");
  CHECK(problem("{staircase: {points: [[0, 0], [1, 0]], times: [0, 1, 2]}}") ==
        staircase + "times: found 3 times for 2 points; allowed: one time for each point");
  CHECK(problem("{staircase: {points: [[0, 0], [1, 0]], times: [1, 1]}}") ==
        staircase + "times.1: found 1, after 1; allowed: strictly increasing times");
}

}  // namespace bbsim_test::test_reference
