// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/live.hpp"

#include <nlohmann/json.hpp>

#include "base/json.hpp"
#include "replay/numbers.hpp"
#include "replay/page.hpp"

namespace bbsim::replay {

using Json = nlohmann::ordered_json;

namespace {

Json loops_json(const std::optional<Live::Loops>& maybe, const Numbers& numbers) {
  if (!maybe) return nullptr;
  const Live::Loops& loops = *maybe;
  Json curves = Json::object();
  for (const auto& [command, gain, phase] : loops.curves) {
    curves[command] = {{"gain", numbers.floats(gain)}, {"phase", numbers.floats(phase)}};
  }
  return {{"stable", loops.stable},
          {"period", loops.period ? Json(*loops.period) : Json()},
          {"frequencies", numbers.floats(loops.frequencies)},
          {"curves", curves},
          {"margins", parse_json(loops.margins)}};
}

}  // namespace

Json live_json(const Live& live, const Numbers& numbers) {
  const auto bound = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  Json keys = Json::array(), tasks = Json::array();
  for (const LiveKey& key : live.keys) {
    keys.push_back({{"key", key.key},
                    {"text", key.text},
                    {"unit", key.unit},
                    {"value", key.value},
                    {"least", bound(key.least)},
                    {"most", bound(key.most)},
                    {"open", key.open},
                    {"whole", key.whole},
                    {"meaning", key.meaning}});
  }
  for (const Live::Task& task : live.tasks) {
    tasks.push_back({{"text", task.text}, {"expect", task.expect}, {"holds", task.holds}});
  }
  Json measures = Json::object();
  for (const Live::Measure& one : live.measures) {
    measures[one.name] = {{"value", one.value}, {"unit", one.unit}};
  }
  return {{"keys", keys},
          {"free", live.free},
          {"tasks", tasks},
          {"measures", measures},
          {"loops", loops_json(live.loops, numbers)}};
}

std::string loops_json(const std::optional<Live::Loops>& loops,
                       std::vector<std::vector<double>>& arrays) {
  return json_text(loops_json(loops, Numbers(&arrays)));
}

}  // namespace bbsim::replay
