// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/live.hpp"

#include "base/number_text.hpp"
#include "scenario/family.hpp"
#include "scenario/key_paths.hpp"
#include "scenario/key_value.hpp"

namespace bbsim::replay {

Live live_of(const Scenario& scenario) {
  const ScenarioFamily family(scenario.source);
  Live live;
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
    live.keys.push_back({path, text, *value, range.at_least ? range.at_least : range.above,
                         range.at_most, number->whole});
  }
  if (auto exercise = scenario::checked_exercise(scenario)) live.exercise = std::move(*exercise);
  return live;
}

}  // namespace bbsim::replay
