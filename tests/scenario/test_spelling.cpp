// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys in American and British spelling.
#include <string>
#include <variant>
#include <vector>

#include "catch.hpp"
#include "scenario/family.hpp"
#include "scenario/reader.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_spelling {

using namespace bbsim;
using namespace bbsim::test;

namespace {

const std::string circle = "controller.reference.circle.";

std::string scene(const std::string& reference) {
  return "ball: {radius: 0.01}\n"
         "time: {end: 10, step: 0.1}\n"
         "controller:\n"
         "  pd: {kv: 100, kp: 0.1}\n"
         "  reference:\n"
         "    circle:\n"
         "      radius: 0.05\n"
         "      rate: 1\n" +
         reference;
}

const std::string in_american = scene("      center: [0.01, 0.02]\n");
const std::string in_british = scene("      centre: [0.01, 0.02]\n");

Pair center_of(const Scenario& scenario) {
  return std::get<CircleReference>(scenario.controller->reference).centre;
}

}  // namespace

TEST_CASE("both spellings of a key are read") {
  CHECK(center_of(parse(in_american)) == Pair{0.01, 0.02});
  CHECK(center_of(parse(in_british)) == Pair{0.01, 0.02});
  for (const std::string law : {"feedback_linearization", "feedback_linearisation"}) {
    CAPTURE(law);
    const Scenario scenario = parse(
        "ball: {radius: 0.01}\ntime: {end: 1, step: 0.1}\n"
        "controller: {" +
        law + ": {kv: 1, kp: 1}, reference: {point: [0, 0]}}\n");
    CHECK(scenario.controller->law == Law::feedback_linearisation);
  }
}

TEST_CASE("an override and the text may spell a key differently") {
  for (const std::string& text : {in_american, in_british}) {
    for (const std::string key : {"center", "centre"}) {
      CAPTURE(text, key);
      CHECK(center_of(parse(text, {circle + key + ".1=0.5"})) == Pair{0.01, 0.5});
      CHECK(center_of(parse(text, {circle + key + "=[3, 4]"})) == Pair{3, 4});
      CHECK(center_of(parse(text, {circle + key + "=null"})) == Pair{0, 0});
      CHECK(errors(text, {circle + key + "=2"})
                .starts_with("--set " + circle + key + "=2: " + circle + key + ": found 2;"));
      CHECK(number_at({"scenario.yaml", text, {}}, circle + key, yaml::Dimension::length) ==
            std::nullopt);
      CHECK(place_of({"scenario.yaml", text, {}}, circle + key) == "scenario.yaml:9:7");
    }
  }
}

TEST_CASE("a family reads a key in either spelling") {
  const ScenarioFamily family({"scenario.yaml", in_british, {}});
  const std::vector<ScenarioFamily::Setting> american{{circle + "center.0", "3 cm"}};
  CHECK(center_of(family.read(american)) == Pair{0.03, 0.02});
  CHECK(family.number_at(american.back().key, american) == 0.03);
  CHECK(family.unit_of(circle + "center.1", {}) == "m");
  CHECK(family.unit_of(circle + "centre.1", {}) == "m");
}

TEST_CASE("parameters of your own controller have one spelling") {
  const std::string text =
      "ball: {radius: 0.01}\ntime: {end: 1, step: 0.1}\n"
      "gimbal: {servo: {natural_frequency: 10, damping: 1}}\n"
      "controller:\n"
      "  program: {command: [\"true\"], parameters: {center: 1, centre: 2}}\n"
      "  drives: angle\n"
      "  sampling: {period: 0.02}\n"
      "  reference: {point: [0, 0]}\n";
  const std::string parameters = "controller.program.parameters.";
  CHECK(errors(text).empty());
  const Scenario scenario = parse(text, {parameters + "centre=null", parameters + "centre=5"});
  const auto& given = scenario.controller->own->parameters;
  REQUIRE(given.size() == 2);
  CHECK(given[0].name == "center");
  CHECK(given[0].value == 1);
  CHECK(given[1].name == "centre");
  CHECK(given[1].value == 5);
}

}  // namespace bbsim_test::test_spelling
