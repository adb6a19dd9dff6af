// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reference paths of a controller.
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "support/folder.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_reference {

using namespace bbsim;
using namespace bbsim::test;

namespace {

const std::string key = "controller.reference";

template <class Kind>
Kind read_as(const std::string& reference) {
  const Scenario scenario = parse(closed_loop, {key + "=" + reference});
  return std::get<Kind>(scenario.controller->reference);
}

}  // namespace

TEST_CASE("points, circles and Lissajous figures have units and defaults") {
  CHECK(read_as<PointReference>("{point: [1 cm, -2]}").position == Pair{0.01, -2});

  const auto circle = read_as<CircleReference>("{circle: {radius: 0, rate: -0.3, phase: 1}}");
  CHECK(circle.radius == 0);
  CHECK(circle.rate == -0.3);
  CHECK(circle.phase == 1);
  CHECK(circle.centre == Pair{0, 0});
  CHECK(read_as<CircleReference>("{circle: {radius: 1, rate: 1, centre: [2 cm, 3]}}").centre ==
        Pair{0.02, 3});

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
}

TEST_CASE("waypoints, steps, square waves and staircases have units and defaults") {
  const auto way = read_as<WaypointReference>(
      "{waypoints: {points: [[0, 0], [5 cm, 0.02], [1, 1]], times: [-1, 500 ms, 2]}}");
  CHECK(way.points == std::vector<Pair>{{0, 0}, {0.05, 0.02}, {1, 1}});
  CHECK(way.times == std::vector<double>{-1, 0.5, 2});
  CHECK_FALSE(way.rest);
  for (const bool rest : {false, true}) {
    const std::string keys = "{waypoints: {points: [[0, 0], [1, 1]], times: [0, 1], rest: ";
    CHECK(read_as<WaypointReference>(keys + (rest ? "true}}" : "false}}")).rest == rest);
  }

  const auto step =
      read_as<StaircaseReference>("{step: {from: [1 cm, 0], to: [0, 2 cm], at: 3 s}}");
  CHECK(step.points == std::vector<Pair>{{0.01, 0}, {0, 0.02}});
  CHECK(step.jumps == std::vector<double>{3});
  const auto least = read_as<StaircaseReference>("{step: {to: [1, 2]}}");
  CHECK(least.points == std::vector<Pair>{{0, 0}, {1, 2}});
  CHECK(least.jumps == std::vector<double>{0});

  const auto wave = read_as<SquareReference>(
      "{square: {amplitude: [5 cm, -0.03], period: 500 ms, phase: [0, 90 deg], center: [0, 1 cm], "
      "duty: 0.25}}");
  CHECK(wave.amplitude == Pair{0.05, -0.03});
  CHECK(wave.period == 0.5);
  CHECK(wave.phase == Pair{0, std::numbers::pi / 2});
  CHECK(wave.centre == Pair{0, 0.01});
  CHECK(wave.duty == 0.25);
  const auto plain = read_as<SquareReference>("{square: {amplitude: [1, 0], period: 1}}");
  CHECK(plain.phase == Pair{0, 0});
  CHECK(plain.centre == Pair{0, 0});
  CHECK(plain.duty == 0.5);

  const auto stairs = read_as<StaircaseReference>(
      "{staircase: {points: [[0, 0], [1 cm, 0], [0, 2 cm]], times: [0, 1, 2500 ms]}}");
  CHECK(stairs.points == std::vector<Pair>{{0, 0}, {0.01, 0}, {0, 0.02}});
  CHECK(stairs.jumps == std::vector<double>{1, 2.5});
}

TEST_CASE("a reference table is found beside its scenario") {
  const Folder folder;
  folder.put("path.csv", "t,a,b\n0,1,2\n2.5,2,3\n5,3,4\n10,5,6\n");
  const std::vector<std::string> set{key + "={table: {file: path.csv, time: t, x: a, y: b}}"};
  const Scenario read = parse_scenario(closed_loop, folder / "scenario.yaml", set);
  const auto& table = std::get<TableReference>(read.controller->reference);
  CHECK(table.file == "path.csv");
  CHECK(table.times == std::vector<double>{0, 2.5, 5, 10});
  CHECK(table.x == std::vector<double>{1, 2, 3, 5});
  CHECK(table.y == std::vector<double>{2, 3, 4, 6});
}

}  // namespace bbsim_test::test_reference
