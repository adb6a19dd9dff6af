// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The lines that bbsim and an external program exchange.
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/noise.hpp"
#include "catch.hpp"
#include "controller/protocol.hpp"
#include "support/text.hpp"

namespace bbsim_test::test_protocol {

using namespace bbsim;
using controller::read_answer;
using nlohmann::json;

namespace {

std::string sample_line(std::size_t number, double t, const std::optional<Pair>& seen,
                        std::span<const double> servo,
                        const std::array<model::Jet<double>, 2>& reference,
                        controller::Fields wanted = controller::Fields().set()) {
  char line[controller::longest_sample];
  const std::size_t half = servo.size() / 2;  // angles, then rates
  return {line,
          controller::write_sample(
              {number, t, seen, servo.first(half), servo.last(half), reference}, wanted, line)};
}

struct Read {
  std::string fault;
  std::vector<double> command;
  std::vector<double> own;
};

Read read(const std::string& line, const std::vector<std::string>& names = {},
          std::size_t commands = 2) {
  Read read;
  read.command.resize(commands);
  read.own.resize(names.size());
  read.fault = read_answer(line, names, read.command, read.own.data());
  return read;
}

}  // namespace

TEST_CASE("numbers in a sample round-trip as doubles and never look like integers") {
  Noise noise(5);
  for (int i = 0; i < 1000; ++i) {
    const auto number = [&noise] { return noise.normal() * std::pow(10, 40 * noise.normal()); };
    const std::optional<Pair> seen{{number(), number()}};
    const double servo[4] = {number(), number(), number(), number()};
    const std::array<model::Jet<double>, 2> reference{
        {{number(), number(), number()}, {number(), number(), number()}}};
    const double t = std::abs(number());
    const json read = json::parse(sample_line(7, t, seen, servo, reference));
    CHECK(read.at("sample") == 7);
    CHECK(read.at("t").get<double>() == t);
    CHECK(read.at("ball") == json{(*seen)[0], (*seen)[1]});
    CHECK(read.at("reference") == json{reference[0].value, reference[1].value});
    CHECK(read.at("reference_rate") == json{reference[0].rate, reference[1].rate});
    CHECK(read.at("reference_acceleration") ==
          json{reference[0].acceleration, reference[1].acceleration});
    CHECK(read.at("servo") == json{servo[0], servo[1]});
    CHECK(read.at("servo_rate") == json{servo[2], servo[3]});
    CHECK(read.size() == 8);
  }
}

TEST_CASE("the longest sample fits its line; zeros keep their sign; unseen values are null") {
  constexpr double longest = -2.2250738585072014e-308;
  const double servo[4] = {longest, longest, longest, longest};
  const std::array<model::Jet<double>, 2> reference{
      {{longest, longest, longest}, {longest, longest, longest}}};
  const std::optional<Pair> seen{{longest, longest}};
  const std::size_t most = std::numeric_limits<std::size_t>::max();
  CHECK(sample_line(most, longest, seen, servo, reference).size() < controller::longest_sample);

  const double zeros[4] = {0.0, -0.0, 1, 1e22};
  const std::string line = sample_line(0, 0, std::nullopt, zeros, {});
  CHECK(
      line ==
      "{\"sample\":0,\"t\":0.0,\"ball\":null,\"reference\":[0.0,0.0],\"reference_rate\":[0.0,0.0],"
      "\"reference_acceleration\":[0.0,0.0],\"servo\":[0.0,-0.0],\"servo_rate\":[1.0,1e+22]}\n");
}

TEST_CASE("a controller gets only the fields that it requests") {
  const controller::Ready ready =
      controller::read_ready("{\"protocol\": 1, \"fields\": [\"servo\", \"ball\", \"sample\"]}");
  CHECK(ready.fault.empty());
  const double servo[4] = {1, 2, 3, 4};
  CHECK(sample_line(3, 0.06, std::nullopt, servo, {}, ready.fields) ==
        "{\"sample\":3,\"ball\":null,\"servo\":[1.0,2.0]}\n");
  const std::optional<Pair> seen{{0.5, -0.25}};
  CHECK(sample_line(3, 0.06, seen, servo, {}, ready.fields) ==
        "{\"sample\":3,\"ball\":[0.5,-0.25],\"servo\":[1.0,2.0]}\n");
  CHECK(sample_line(3, 0.06, seen, servo, {}, {}) == "{\"sample\":3}\n");
}

TEST_CASE("an answer may use any valid JSON formatting") {
  for (const char* line : {"{\"command\": [0.5, -1e-3]}", "{\"command\":[0.5,-0.001]}",
                           " { \"command\" : [ 0.5 , -0.001 ] } \r",
                           "{\"u\": 3, \"command\": [0.5, -0.001], \"v\": NaN}"}) {
    CAPTURE(line);
    const Read answer = read(line);
    CHECK(answer.fault.empty());
    CHECK(answer.command == std::vector{0.5, -0.001});
  }
  // Words for numbers that are not finite, but not within names; and a number called error.
  for (const char* line : {"{\"info\": 1, \"command\": [0, 1], \"extra\": nan, \"error\": 0.5}",
                           "{\"info\": 1, \"command\": [0, 1], \"error\": 0.5}"}) {
    CAPTURE(line);
    const Read kept = read(line, {"info", "error"});
    CHECK(kept.fault.empty());
    CHECK(kept.own == std::vector<double>{1, 0.5});
  }
  const Read named = read("{\"b\": 2, \"command\": [0, 1], \"a\": -1.5e3, \"c\": 9}", {"a", "b"});
  CHECK(named.fault.empty());
  CHECK(named.own == std::vector<double>{-1500, 2});
}

TEST_CASE("an answer over a serial line has bytes and numbers, and says which is not finite") {
  const std::vector<std::string> names{"info"};
  double own = 0;
  const auto answer =
      controller::read_serial_answer("{\"serial\": \"a\\u00ff\", \"info\": 2}", names, &own);
  CHECK(answer.fault.empty());
  CHECK(answer.bytes == "a\xff");
  CHECK(own == 2);
  for (const char* word : {"NaN", "-inf"}) {
    const std::string line = std::string("{\"serial\": \"nan\", \"info\": ") + word + "}";
    const auto refused = controller::read_serial_answer(line, names, &own);
    CHECK(contains(refused.fault, "found no finite \"info\""));
    CHECK(refused.bytes == "nan");
  }
}

TEST_CASE("faults of a controller's lines are told, a misspelled name with the likely one") {
  const YAML::Node page = YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/controller/faults.yaml");
  for (const std::string kind : {"answers", "greetings"}) {
    for (const YAML::Node& row : page[kind]) {
      const auto line = row[0].as<std::string>();
      const std::string fault =
          kind == "answers" ? read(line, {"a"}).fault : controller::read_ready(line).fault;
      CAPTURE(line, fault);
      CHECK_FALSE(fault.empty());
      CHECK(contains(fault, row[1].as<std::string>()));
    }
  }
}

TEST_CASE("a column that an answer lacks is reported with the likely name, if there is one") {
  CHECK(contains(read("{\"command\": [0, 0], \"x_integal\": 1}", {"x_integral"}).fault,
                 "found no \"x_integral\", which output.columns asks for, but \"x_integal\" (did "
                 "you mean x_integral?)"));
  for (const char* const line : {"{\"command\": [0, 0], \"error\": 5}",
                                 "{\"command\": [0, 0], \"a\": []}", "{\"motor\": [0, 0]}"}) {
    CHECK_FALSE(contains(read(line, {"a"}).fault, "did you mean"));
  }
}

TEST_CASE("an unknown name is shown, and cut if it is long") {
  const std::string longest(60000, 'f');
  for (const std::string& line : {"{\"protocol\": 1, \"fields\": [\"" + longest + "\"]}",
                                  "{\"protocol\": 1, \"fields\": [[\"" + longest + "\"]]}",
                                  "{\"protocol\": 1, \"" + longest + "\": 1}",
                                  "{\"protocol\": 1, \"columns\": {\"" + longest + "\": 1}}"}) {
    CAPTURE(line.substr(0, 40));
    const std::string fault = controller::read_ready(line).fault;
    CHECK_FALSE(fault.empty());
    CHECK(fault.size() < 1000);
  }
}

TEST_CASE("a controller's output may nest only so deep") {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  const std::string deep = nested(30000);  // a line may be as long as this
  CHECK_FALSE(controller::read_ready("{\"protocol\": 1, \"fields\": " + deep + "}").fault.empty());
  CHECK_FALSE(read("{\"a\": " + deep + "}").fault.empty());
}

TEST_CASE("a hello describes the run, and its answer the controller's abilities") {
  controller::Setup setup;
  setup.period = 0.02;
  setup.limit = std::numeric_limits<double>::infinity();
  setup.parameters = {{"kp", 0.7}, {"ki", 0.1}};
  setup.columns = {"u"};
  const std::string line = controller::hello_line(setup);
  CHECK(line.find('\n') == line.size() - 1);
  const json hello = json::parse(line);
  CHECK(hello.at("protocol") == 1);
  CHECK(hello.at("period") == 0.02);
  CHECK(hello.at("limit").is_null());
  CHECK(hello.at("parameters") == json{{"kp", 0.7}, {"ki", 0.1}});
  CHECK(hello.at("columns") == json::array({"u"}));
  // Every field of a sample with its unit, and no other.
  const double servo[4] = {};
  const json sample = json::parse(sample_line(0, 0, std::nullopt, servo, {}));
  CHECK(hello.at("fields").size() == sample.size());
  for (const auto& [name, unit] : hello.at("fields").items()) CHECK(sample.contains(name));

  for (const auto& [drives, word, unit] :
       {std::tuple{Drives::angle, "angle", "rad"},
        std::tuple{Drives::acceleration, "acceleration", "rad/s^2"},
        std::tuple{Drives::torque, "torque", "N m"}, std::tuple{Drives::voltage, "voltage", "V"},
        std::tuple{Drives::legs, "legs", "rad"}}) {
    setup.drives = drives;
    const json driven = json::parse(controller::hello_line(setup));
    CHECK(driven.at("drives") == word);
    CHECK(driven.at("command") == unit);
  }

  CHECK(controller::read_ready("{\"protocol\": 1}").fault.empty());
  const controller::Ready ready =
      controller::read_ready("{\"protocol\": 1, \"reset\": true, \"columns\": {\"u\": \"rad\"}}");
  CHECK(ready.fault.empty());
  CHECK(ready.reset);
  REQUIRE(ready.columns);
  CHECK(ready.columns->front() == std::pair<std::string, std::string>("u", "rad"));
}

TEST_CASE("with three legs a sample has three servos, and an answer three commands") {
  const double servo[6] = {0.1, 0.2, 0.3, 1, 2, 3};
  const std::string line = sample_line(0, 0, std::nullopt, servo, {});
  CHECK(line.ends_with("\"servo\":[0.1,0.2,0.3],\"servo_rate\":[1.0,2.0,3.0]}\n"));
  const Read answer = read("{\"command\": [0.1, -0.2, 0.3]}", {}, 3);
  CHECK(answer.fault.empty());
  CHECK(answer.command == std::vector{0.1, -0.2, 0.3});
  CHECK(
      read("{\"command\": [0.1, 0.2]}", {}, 3)
          .fault.ends_with("found a command that is not three numbers; allowed: {\"command\": [S1, "
                           "S2, S3]}, optionally with \"NAME\": NUMBER"));
  CHECK(!read("{\"command\": [0.1, 0.2, 1e999]}", {}, 3).fault.empty());
}

}  // namespace bbsim_test::test_protocol
