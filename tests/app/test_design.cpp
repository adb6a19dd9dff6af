// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim design, from the command line to its files, and its sketch on the simulated board.
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_design {

using Catch::Matchers::Contains;

namespace {

const std::string rig = R"(
ball: {radius: 2 cm}
plate: {size: [32 cm, 32 cm]}
gimbal: {motion: {phi: 0, theta: 0}}
time: {end: 2, step: 20 ms}
)";

std::vector<std::string> design(const std::vector<std::string>& more) {
  std::vector<std::string> words{"design", "rig.yaml", "--free", "ball.inertia_factor", "-q"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) numbers.push_back(std::stod(field));
  return numbers;
}

}  // namespace

TEST_CASE("design writes a scenario that runs, its table, and JSON") {
  const Folder folder;
  folder.write("rig.yaml", rig);
  const Result result =
      bbsim(design({"-o", "designed.yaml", "--json", "designed.json"}), folder.path());
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out,
             Contains("ball.inertia_factor") && Contains("begin with the ball at rest"));
  const auto json = nlohmann::json::parse(folder.read("designed.json"));
  CHECK(json["parameters"][0]["key"] == "ball.inertia_factor");
  CHECK(lines_of(folder.read("designed-motion.csv")).size() == 102);
  CHECK(bbsim({"run", "designed.yaml", "-q"}, folder.path()).exit_code == 0);

  const Result again =
      bbsim(design({"-o", "designed.yaml", "--table", "designed.yaml"}), folder.path());
  CHECK(again.exit_code == 2);
  CHECK_THAT(again.err, Contains("--table: found designed.yaml; allowed: FILE.csv"));
  CHECK_THAT(bbsim(design({"-o", "-"}), folder.path()).err,
             Contains("--table: found no file, and the scenario of -o must name one"));
}

TEST_CASE("design can print only its table") {
  const Folder folder;
  folder.write("rig.yaml", rig);
  const Result result = bbsim(design({"--table", "-"}), folder.path());
  REQUIRE(result.exit_code == 0);
  const auto lines = lines_of(result.out);
  REQUIRE(lines.size() == 102);
  CHECK(lines[0] == "t,phi,theta");
  CHECK(lines[1] == "0,0,0");
  CHECK(lines[101] == "2,0,0");
}

TEST_CASE("design finds a table in a folder other than that of the scenario that plays it") {
  const Folder folder;
  folder.write("rig.yaml", rig);
  std::filesystem::create_directory(folder.path() / "tables");
  REQUIRE(
      bbsim(design({"-o", "designed.yaml", "--table", "tables/it.csv"}), folder.path()).exit_code ==
      0);
  CHECK_THAT(folder.read("designed.yaml"), Contains("file: 'tables/it.csv'"));
  CHECK(bbsim({"run", "designed.yaml", "-q"}, folder.path()).exit_code == 0);
}

TEST_CASE("the sketch of a design plays it and prints a log with clock and units") {
  const Folder folder;
  folder.write("rig.yaml", rig);
  REQUIRE(bbsim(design({"--table", "it.csv", "--sketch", "play.ino"}), folder.path()).exit_code ==
          0);
  const Result compiled = bbsim({"sketch", "play.ino", "-o", "play.so"}, folder.path());
  INFO(compiled.err);
  REQUIRE(compiled.exit_code == 0);
  // 0.1 degrees per microsecond, as the sketch assumes.
  folder.write("wiring.yaml", R"(
servos:
  phi: {pin: 9, level: "1500 us", scale: "0.1 deg"}
  theta: {pin: 10, level: "1500 us", scale: "0.1 deg"}
screen:
  voltages: {x: A0, y: A1}
  x: {counts: [12, 1012], position: ["-16 cm", "16 cm"]}
  y: {counts: [12, 1012], position: ["-16 cm", "16 cm"]}
  untouched: 0
setup: during
print: all
)");
  folder.write("board.yaml", R"(
ball: {radius: 2 cm}
gimbal: {servo: {natural_frequency: 8 Hz, damping: 0.9}}
controller:
  library: {file: play.so, wiring: wiring.yaml}
  drives: angle
  reference: {point: [0, 0]}
  sampling: {period: 2 ms}
time: {end: 7.2, step: 20 ms}
)");
  const Result run = bbsim({"run", "board.yaml", "-o", "board.csv"}, folder.path());
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  std::vector<std::string> log;
  const std::string mark = "controller: ";
  for (const std::string& line : lines_of(run.err)) {
    if (line.starts_with(mark)) log.push_back(line.substr(mark.size()));
  }
  const auto table = lines_of(folder.read("it.csv"));
  REQUIRE(log.size() == table.size());
  CHECK(log[0] == "t_ms,phi_deg,theta_deg,x_mm,y_mm");
  constexpr double degree = 0.017453292519943295;
  for (std::size_t row = 1; row < log.size(); ++row) {
    const auto played = numbers_of(log[row]), asked = numbers_of(table[row]);
    CAPTURE(log[row], table[row]);
    REQUIRE(played.size() == 5);
    // The sketch's loop may be a millisecond or two late; rounding is a thousandth of a degree.
    CHECK(std::abs(played[0] - 1000 * asked[0]) < 3);
    CHECK(std::abs(played[1] - asked[1] / degree) < 0.0011);
    CHECK(std::abs(played[2] - asked[2] / degree) < 0.0011);
  }
}

}  // namespace bbsim_test::test_design
