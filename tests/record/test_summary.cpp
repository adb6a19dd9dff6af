// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The summary agrees in JSON and in attributes.
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "record/summary.hpp"

namespace bbsim_test::test_summary {

using bbsim::file::AttributeValue;
using bbsim::record::RunSummary;
using bbsim::record::to_attributes;
using bbsim::record::to_json;

namespace {

RunSummary a_run() {
  RunSummary run;
  run.version = "0.1.0";
  run.instruction_set = "avx2";
  run.scenario = "configs/fig2a.yaml";
  run.scenario_text = "ball: {radius: 0.01}\n";
  run.title = "Fig. 2(a), \"open\" loop: φ";
  run.overrides = {"ball.radius=0.02", "time.end=5"};
  run.status = "done";
  run.warnings = {"the ball is off the plate"};
  run.end_time = 10;
  run.rows = 101;
  run.output = "fig2a.csv";
  run.states = {"x", "y"};
  run.model_notes = {"the gimbal is prescribed"};
  run.method = "adams";
  run.rtol = 1e-8;
  run.atol = 0.1;
  run.statistics = {{200, 300, 4, 500, 6}, 1.0 / 3};
  return run;
}

}  // namespace

TEST_CASE("the summary is JSON of all that is known of the run, in this order") {
  const auto json = nlohmann::ordered_json::parse(to_json(a_run()));
  CHECK(json == nlohmann::ordered_json::parse(R"({"version": "0.1.0", "instruction_set": "avx2",
    "scenario": "configs/fig2a.yaml", "title": "Fig. 2(a), \"open\" loop: φ",
    "overrides": ["ball.radius=0.02", "time.end=5"], "status": "done", "reason": "",
    "reason_code": "none", "warnings": ["the ball is off the plate"], "end_time": 10.0,
    "rows": 101, "output": "fig2a.csv", "states": ["x", "y"],
    "model_notes": ["the gimbal is prescribed"], "method": "adams", "rtol": 1e-08, "atol": 0.1,
    "events": [], "statistics": {"steps": 200, "rhs_evaluations": 300, "jacobian_evaluations": 4,
      "nonlinear_iterations": 500, "error_test_failures": 6, "cpu_seconds": 0.3333333333333333},
    "scenario_text": "ball: {radius: 0.01}\n"})"));
}

TEST_CASE("the summary's numbers round-trip bit for bit or are null") {
  RunSummary run = a_run();
  for (const double value : {1.0 / 3, 5e-324, -0.0, 1.7976931348623157e308, 0.1 + 0.2}) {
    run.end_time = value;
    const auto back = nlohmann::json::parse(to_json(run)).at("end_time").get<double>();
    CHECK(std::bit_cast<std::uint64_t>(back) == std::bit_cast<std::uint64_t>(value));
  }
  for (const double value :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    run.end_time = value;
    CHECK(nlohmann::json::parse(to_json(run)).at("end_time").is_null());
  }
}

TEST_CASE("a file name that is not UTF-8 leaves the summary valid") {
  RunSummary run = a_run();
  run.output = "fig\xff.csv";
  CHECK(nlohmann::json::parse(to_json(run)).at("output") == "fig\xEF\xBF\xBD.csv");
}

TEST_CASE("attributes have the summary's names and values, with numbers as numbers") {
  const auto attributes = to_attributes(a_run(), "ball: {radius: 0.01}\n");
  const auto json = nlohmann::json::parse(to_json(a_run()));
  const auto value = [&](const std::string& name) -> AttributeValue {
    for (const auto& [key, known] : attributes) {
      if (key == name) return known;
    }
    return "absent";
  };
  const auto same = [&](const std::string& name, const nlohmann::json& member) {
    CAPTURE(name);
    if (name == "output" || name == "cpu_seconds") {  // equal runs differ in these
      CHECK(value(name) == AttributeValue("absent"));
    } else if (member.is_string()) {
      CHECK(value(name) == AttributeValue(member.get<std::string>()));
    } else if (member.is_number_integer()) {
      CHECK(value(name) == AttributeValue(member.get<std::int64_t>()));
    } else if (member.is_number()) {
      CHECK(value(name) == AttributeValue(member.get<double>()));
    }
  };
  for (const auto& [name, member] : json.items()) same(name, member);
  for (const auto& [name, member] : json.at("statistics").items()) same(name, member);
  CHECK(attributes.size() == json.size() - 2 + json.at("statistics").size() - 1);
  CHECK(value("overrides") == AttributeValue("ball.radius=0.02\ntime.end=5"));
  CHECK(value("states") == AttributeValue("x\ny"));
  CHECK(value("scenario_text") == AttributeValue("ball: {radius: 0.01}\n"));
}

TEST_CASE("equal runs have equal attributes, whatever the output") {
  RunSummary other = a_run();
  other.output = "elsewhere.h5";
  other.statistics.cpu_seconds = 7;
  CHECK(to_attributes(other, "") == to_attributes(a_run(), ""));
}

}  // namespace bbsim_test::test_summary
