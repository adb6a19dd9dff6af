// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/tune_text.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/fit_text.hpp"
#include "api/version.hpp"
#include "base/json.hpp"
#include "base/number_text.hpp"
#include "base/short_number.hpp"
#include "record/aligned.hpp"

namespace bbsim::api {
namespace {

using Json = nlohmann::ordered_json;

std::string with_window(const scenario::Measure& measure) {
  return measure.window_text.empty() ? measure.name : measure.name + ' ' + measure.window_text;
}

Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

// "the worst of 200 rigs"
std::string rigs_text(const TuneRequest& request, const Tuned& tuned) {
  if (tuned.rigs == 1) return "one rig";
  const std::string rigs = std::to_string(tuned.rigs) + " rigs";
  return request.quantile < 1 ? "the " + short_number(request.quantile) + " quantile of " + rigs
                              : "the worst of " + rigs;
}

std::string share_text(const Tuned& tuned) {
  return rounded(100 * tuned.share_that_holds, 4) + " % of " + std::to_string(tuned.held_out) +
         " rigs held out";
}

}  // namespace

std::string report_of(const TuneRequest& request, const Tuned& tuned) {
  std::vector<std::vector<std::string>> keys{{"key", "before", "tuned", "from", "to", "unit"}};
  for (const Tuned::Parameter& one : tuned.parameters) {
    keys.push_back({one.key, short_number(one.before), short_number(one.value),
                    short_number(one.from), short_number(one.to), record::unit_or_one(one.unit)});
  }
  std::vector<std::vector<std::string>> measures{{"measure", "before", "tuned", "unit", "holds"}};
  measures.push_back({with_window(tuned.minimized), record::rounded(tuned.before),
                      record::rounded(tuned.objective), record::unit_or_one(tuned.minimized.unit()),
                      "-"});
  for (const Tuned::Requirement& one : tuned.requirements) {
    measures.push_back(
        {one.expectation.text, record::rounded(one.before), record::rounded(one.value),
         record::unit_or_one(one.expectation.measure.unit()), one.holds ? "yes" : "no"});
  }
  std::string text = record::aligned(keys) + "\n" + record::aligned(measures) + "\n";
  text += "on " + rigs_text(request, tuned) + "; " + std::to_string(tuned.tried) + " tries\n";
  if (tuned.held_out > 0) text += "all requirements hold on " + share_text(tuned) + "\n";
  return text;
}

std::string json_of(const Tuned& tuned) {
  Json json;
  json["parameters"] = Json::array();
  for (const Tuned::Parameter& one : tuned.parameters) {
    json["parameters"].push_back({{"key", one.key}, {"value", one.value}});
  }
  json["objective"] = finite_or_null(tuned.objective);
  json["requirements"] = Json::array();
  for (const Tuned::Requirement& one : tuned.requirements) {
    json["requirements"].push_back({{"text", one.expectation.text},
                                    {"value", finite_or_null(one.value)},
                                    {"holds", one.holds}});
  }
  json["hold_out"] = {
      {"cases", tuned.held_out},
      {"share_that_holds", tuned.held_out > 0 ? Json(tuned.share_that_holds) : Json(nullptr)}};
  return json_text(json, 2) + '\n';
}

std::string tuned_scenario(const TuneRequest& request, const Tuned& tuned) {
  std::string text =
      "# Tuned by bbsim " + std::string(version()) + " on " + rigs_text(request, tuned) + "\n";
  const auto add = [&](const std::string& what, double value, const std::string& unit) {
    text += "#   " + what + ": " + short_number(value) + (unit.empty() ? "" : " " + unit) + "\n";
  };
  add(with_window(tuned.minimized), tuned.objective, tuned.minimized.unit());
  for (const Tuned::Requirement& one : tuned.requirements) {
    add(one.expectation.text + (one.holds ? "" : " (does not hold)"), one.value,
        one.expectation.measure.unit());
  }
  if (tuned.held_out > 0) text += "# All requirements hold on " + share_text(tuned) + ".\n";
  std::vector<ScenarioFamily::Setting> settings;
  for (const Tuned::Parameter& one : tuned.parameters) {
    settings.push_back(
        {one.key, number_text(one.value) + (one.unit.empty() ? "" : " " + one.unit)});
  }
  return edited_scenario(request.family.source(), text, std::move(settings));
}

}  // namespace bbsim::api
