// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>

#include "base/error.hpp"
#include "catch.hpp"
#include "results/result.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_read_result {

using namespace bbsim;
using Catch::Matchers::Contains;

namespace {

const std::string summary_of_two_rows =
    R"({"status": "stopped", "title": "A title", "end_time": 0.5, "rows": 2, "output": "run.csv",
        "overrides": ["plate.size=[0.4, 0.2]"], "scenario": "/nowhere/scene.yaml",
        "events": [{"t": 0.25, "event": "edge", "action": "stop", "x": 0.1, "y": -0.2}],
        "scenario_text": "ball: {radius: 0.01}\nplate: {size: [0.3, 0.2]}\ngimbal: {motion: {phi: {table: {file: gone.csv, time: t, value: p}}}}\nevents: {slip: {friction: 0.3}}\ntime: {end: 1, step: 0.1}\n"})";

results::Result read(const std::string& file, const results::Beside& beside = {}) {
  return results::read_result(file, beside);
}

}  // namespace

TEST_CASE("CSV of any origin: gaps, quotes, byte order marks and line ends, text") {
  const Folder folder;
  const results::Result result = read(folder.put(
      "a.csv",
      "\xEF\xBB\xBFt, x ,\"a name, quoted\",note\r\n0,1,2,\r\n1,,+3,late\r\n\r\n2,nan,-4e3,x\r\n"));
  CHECK(result.rows == 3);
  REQUIRE(result.find("x") != nullptr);
  CHECK(result.find("x")->numbers[0] == 1);
  CHECK(std::isnan(result.find("x")->numbers[1]));
  CHECK_FALSE(result.find("x")->is_text());
  CHECK(result.find("a name, quoted")->numbers == std::vector<double>{2, 3, -4000});
  CHECK(result.find("note")->texts == std::vector<std::string>{"", "late", "x"});
  CHECK_FALSE(result.is_sweep());
}

TEST_CASE("a result that is no table is refused with its place") {
  const Folder folder;
  const auto [content, said] = GENERATE(table<std::string, std::string>({
      {"", "a.csv:1:1: found no header"},
      {"t,x\n", "has a header and no rows"},
      {"1,2\n3,4\n", "a.csv:1:1: found the number"},
      {"t,x\n1,2\n3\n4,5\n", "a.csv:3:1: found 1 number; the header names 2"},
      {"t,t\n1,2\n", "column \"t\" appears twice"},
      {"t,\n1,2\n", "a column's name is empty"},
      {"t,x\n1,\"2\n", "a.csv:2:1: found a quotation mark"},
      {{"\0\1\2", 3}, "a control character in the header"},
  }));
  CHECK_THROWS_WITH(read(folder.put("a.csv", content)), Contains(said));
  CHECK_THROWS_WITH(read("/dev/zero"), Contains("more than 1048576 bytes"));
  CHECK_THROWS_WITH(read(folder / "none.csv"), Contains("no such file"));
  CHECK_THROWS_WITH(read(folder.name()), Contains("is a directory"));
  CHECK_THROWS_WITH(read("scene.yaml"), Contains("is a scenario; allowed: a table"));
}

TEST_CASE("a summary beside a CSV describes its scene if it is of the same run") {
  const Folder folder;
  const std::string csv = folder.put("run.csv", "t,x\n0,1\n0.25,2\n");
  CHECK(read(csv).title.empty());
  folder.put("run.json", summary_of_two_rows);
  const results::Result result = read(csv);
  CHECK(result.title == "A title");
  CHECK(result.status == "stopped");
  REQUIRE(result.events.size() == 1);
  CHECK(result.events[0].name == "edge");
  CHECK(result.events[0].stopped);
  CHECK(result.events[0].y == -0.2);
  // The scenario's table is gone; everything else is known, including settings.
  REQUIRE(result.scenario);
  REQUIRE(result.scenario->plate.size);
  CHECK((*result.scenario->plate.size)[0] == 0.4);
  CHECK(result.scenario->events.slip->friction == 0.3);

  // Another run's summary is ignored by default, and refused if named.
  const std::string other = folder.put("other.csv", "t,x\n0,1\n0.25,2\n0.5,3\n");
  folder.put("other.json", summary_of_two_rows);
  CHECK(read(other).title.empty());
  CHECK(read(other).left_out.empty());  // it does not claim to be of that file
  CHECK_THROWS_WITH(read(other, {folder / "run.json", "", {}}),
                    Contains("of another run: it has 2 rows"));
  CHECK_THROWS_WITH(read(csv, {csv, "", {}}), Contains("is not a summary"));
  CHECK_THROWS_WITH(read(csv, {folder / "none.json", "", {}}), Contains("no such file"));
  folder.put("run.csv", "t,x\n0,1\n0.25,2\n0.5,3\n");
  CHECK(read(csv).title.empty());
  CHECK_THAT(read(csv).left_out, Contains("run.json: left out, since it has another number"));
  folder.put("run.csv", "t,x\n0,1\n0.25,2\n");
  // A summary older than the rewritten file is from an earlier run.
  namespace fs = std::filesystem;
  fs::last_write_time(csv, fs::last_write_time(folder / "run.json") + std::chrono::seconds(3));
  CHECK(read(csv).events.empty());
  CHECK_THAT(read(csv).left_out, Contains("run.json: left out, since it is older than"));
  CHECK(read(csv, {folder / "run.json", "", {}}).events.size() == 1);
  fs::last_write_time(csv, fs::last_write_time(folder / "run.json"));
  CHECK(read(csv).left_out.empty());
  folder.put("run.json",
             "{\"status\": 3, \"events\": [1, {}], \"output\": \"run.csv\", \"rows\": 2}");
  CHECK(read(csv).title.empty());
}

TEST_CASE("units are bbsim's if the table is known to be from bbsim") {
  const Folder folder;
  const auto known = [&](const std::string& text) {
    return read(folder.put("a.csv", text)).units_known;
  };
  // A log may have bbsim's column names, or all digits of a double.
  CHECK_FALSE(known("t,x,y\n0,-12.5,3\n0.1,-12.25,3\n"));
  CHECK_FALSE(known("t,x,y\n0,-12.345678901234567,3\n"));
  CHECK_FALSE(known("t,x,y,x_reference\n0,-12.5,3,0\n"));
  CHECK_FALSE(known("t,x,y,x_reference,mine\n0,-0.12345678901234567,3,0,0\n"));
  CHECK(known("t,x,y,x_reference\n0,-0.12345678901234567,3,0\n"));
  CHECK(known("case,ball.radius,status\n0,1,done\n"));
  const std::string csv = folder.put("run.csv", "t,x\n0,1\n0.25,2\n");
  CHECK_FALSE(read(csv).units_known);
  folder.put("run.json", summary_of_two_rows);
  CHECK(read(csv).units_known);
}

TEST_CASE("an event that stopped a run gives its state") {
  const Folder folder;
  const std::string csv = folder.put("run.csv", "t,x\n0,1\n0.25,2\n");
  folder.put("run.json",
             R"({"status": "stopped", "rows": 2, "output": "run.csv", "events":
                 [{"t": 0.3, "event": "edge", "action": "stop", "x": 0.1, "y": -0.2, "phi": 0.5,
                   "what": 3}]})");
  results::Result result = read(csv);
  CHECK(result.events.at(0).state ==
        std::map<std::string, double>{{"t", 0.3}, {"x", 0.1}, {"y", -0.2}, {"phi", 0.5}});
  CHECK(result.rows == 2);  // the file's rows, until requested
  results::add_end_row(result);
  CHECK(result.find("x")->numbers == std::vector<double>{1, 2, 0.1});
}

TEST_CASE("a named scenario takes precedence over the one beside the file") {
  const Folder folder;
  const std::string csv = folder.put("run.csv", "t,x\n0,1\n0.25,2\n");
  folder.put("run.json", summary_of_two_rows);
  const std::string scene = folder.put(
      "scene.yaml",
      "title: Another\nball: {radius: 0.01}\nplate: {diameter: 0.5}\ngimbal: {motion: {phi: 0}}\n"
      "time: {end: 1, step: 0.1}\n");
  const results::Result result = read(csv, {"", scene, {"plate.diameter=0.6"}});
  CHECK(result.title == "Another");
  CHECK(result.scenario->plate.diameter == 0.6);
  CHECK(result.events.size() == 1);
  CHECK_THROWS_AS(read(csv, {"", scene, {"plate.diametre=0.6"}}), InputError);
}

}  // namespace bbsim_test::test_read_result
