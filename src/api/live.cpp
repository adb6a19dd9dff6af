// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/live.hpp"

#include "base/number_text.hpp"
#include "scenario/exercise.hpp"
#include "scenario/family.hpp"
#include "scenario/key_paths.hpp"
#include "scenario/key_value.hpp"
#include "scenario/measures.hpp"

namespace bbsim::api {
namespace {

std::vector<replay::LiveKey> keys_of(const ScenarioFamily& family) {
  std::vector<replay::LiveKey> keys;
  for (const std::string& path : scenario::key_paths()) {
    const auto number = scenario::number_key(path);
    if (!number) continue;
    const std::optional<double> value = family.number_at(path, {});
    if (!value) continue;
    const yaml::Range& range = number->range;
    std::string text = family.text_at(path);
    if (text.empty()) {  // an item of a list
      text = number_text(*value) + ' ' + std::string(family.unit_of(path, {}));
    }
    keys.push_back({path, text, *value, range.at_least ? range.at_least : range.above,
                    range.at_most, !range.at_least && range.above, number->whole});
  }
  return keys;
}

}  // namespace

LiveRun::LiveRun(RunRequest& request) : source_(request.scenario.source) {
  const Scenario& scenario = request.scenario;
  request.pictured = true;
  const bool closed_loop = scenario.controller && commands_of(scenario) == nullptr;
  request.measures = scenario::default_measures(closed_loop);
  if (auto exercise = scenario::checked_exercise(scenario)) exercise_ = std::move(*exercise);
  for (const auto& task : exercise_.tasks) request.expect.push_back(task.expect);
}

replay::Live LiveRun::of(const RunResult& result, bool with_keys) const {
  replay::Live live;
  if (with_keys) live.keys = keys_of(ScenarioFamily(source_));
  live.free = exercise_.free;
  for (std::size_t i = 0; i < exercise_.tasks.size(); ++i) {
    const auto& [text, expect] = exercise_.tasks[i];
    live.tasks.push_back({text, expect, result.summary.expectations[i].holds});
  }
  for (const auto& [name, value] : result.summary.measures) {
    live.measures.push_back({name, scenario::find_measure(name)->unit(), value});
  }
  return live;
}

}  // namespace bbsim::api
