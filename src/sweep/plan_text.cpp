// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/plan_text.hpp"

#include <nlohmann/json.hpp>

#include "base/json.hpp"
#include "base/text.hpp"

namespace bbsim::sweep {
namespace {

std::string instruction_set_of(const Json& plan) {
  const auto found = plan.find("instruction_set");
  return found != plan.end() && found->is_string() ? found->get<std::string>() : "unknown";
}

}  // namespace

PlanDifference compare_plans(const std::string& first, const std::string& second, bool of_shards) {
  const Json a = parse_json(first), b = parse_json(second);
  if (!a.is_object() || !b.is_object()) return {"text, which is not a plan of bbsim", {}};
  PlanDifference difference;
  const auto note = [&](const std::string& key) {
    if (key == "instruction_set") {
      difference.instruction_sets = {instruction_set_of(a), instruction_set_of(b)};
    } else if (key != "shard" || !of_shards) {
      difference.keys += (difference.keys.empty() ? "" : ", ") + shown(key);
    }
  };
  for (const auto& [key, value] : a.items()) {
    if (!b.contains(key) || b.at(key) != value) note(key);
  }
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key)) note(key);
  }
  return difference;
}

std::optional<PlanFacts> facts_in(const std::string& plan) {
  const Json json = parse_json(plan);
  if (!json.is_object()) return {};
  PlanFacts facts{{}, instruction_set_of(json)};
  const auto cases = json.find("cases");
  if (cases != json.end() && cases->is_number_unsigned()) facts.cases = cases->get<std::size_t>();
  return facts;
}

}  // namespace bbsim::sweep
