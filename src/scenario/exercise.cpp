// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/exercise.hpp"

#include <algorithm>
#include <string_view>

#include "base/error.hpp"
#include "scenario/expectation.hpp"
#include "scenario/keys.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::scenario {
namespace {

constexpr std::size_t most_items = 1000;

// The message of an error without the place or the option that it begins with.
std::string without_place(const std::string& message, const std::string& place) {
  return message.starts_with(place + ": ") ? message.substr(place.size() + 2) : message;
}

void check_expect(const yaml::Value& expect, const Scenario& scenario) {
  try {
    static_cast<void>(read_expectation(expect.path, expect.node->text, scenario));
  } catch (const InputError& error) {
    expect.report(without_place(error.what(), expect.path));
  }
}

// Refuses a key that is unknown, or neither a number nor a name.
bool refuse_unknown(const yaml::Value& key) {
  const std::vector<std::string> paths = key_paths();
  const std::vector<std::string_view> names(paths.begin(), paths.end());
  const std::string name = yaml::american(key.node->text);
  const bool known = std::ranges::find(names, name) != names.end();
  return key.refuse(known ? ", which is neither" : yaml::hint(name, names),
                    "a key that is a number or one of several names, such as controller.pd.kp");
}

// A key without a value and without a default needs at least the mapping that it belongs to.
void check_free(const yaml::Value& item, const ScenarioFamily& family) {
  const std::string& key = item.node->text;
  const std::optional<std::string> standard = scalar_default(key);
  if (!standard) {
    refuse_unknown(item);
    return;
  }
  if (!family.text_at(key).empty() || family.number_at(key, {})) return;
  if (standard->empty()) {
    const std::string section = key.substr(0, key.rfind('.'));
    if (family.text_at(section).empty()) {
      item.refuse(", but this scenario has no " + section, "a key of a part that it has");
    }
    return;
  }
  try {
    static_cast<void>(family.read({{key, *standard}}));
  } catch (const InputError& error) {
    item.refuse(", which has no place in this scenario (" +
                    without_place(error.problems().front().message, key) + ')',
                "a key that --set can change");
  }
}

void check_items(const yaml::Value& section, const Scenario& scenario) {
  yaml::Keys keys(section);
  if (const auto tasks = keys.find("tasks")) {
    for (std::size_t i = 0; i < tasks->node->items.size(); ++i) {
      check_expect(*yaml::Keys(tasks->item(i)).find("expect"), scenario);
    }
  }
  const auto free = keys.find("free");
  if (!free) return;
  const ScenarioFamily family(scenario.source);
  for (std::size_t i = 0; i < free->node->items.size(); ++i) {
    check_free(free->item(i), family);
  }
}

void read_task(yaml::Keys& keys, Exercise::Task& task) {
  keys.required("text", yaml::Text{"a text, such as \"Hold the ball within 3 mm.\"", true},
                task.text, {"what the learner should reach"});
  keys.required("expect",
                yaml::Text{"\"MEASURE < VALUE\", or with <=, > or >=, such as \"max_tilt < 5 "
                           "deg\""},
                task.expect,
                {"the bound that decides it, as in `run --expect`: `max_distance < 3 mm`"});
}

}  // namespace

void read_exercise(yaml::Keys& keys, Exercise& exercise) {
  const yaml::ListOf<yaml::MappingOf<Exercise::Task>, Exercise::Task> tasks{
      yaml::MappingOf(read_task), 1, most_items, "tasks {text, expect}"};
  keys.optional("tasks", tasks, exercise.tasks, {"a list of mappings, one for each task"});
  const yaml::ListOf<yaml::Text, std::string> names{
      {"a key of the scenario"}, 0, most_items, "keys, such as controller.pd.kp", "each key once"};
  keys.optional("free", names, exercise.free,
                {"keys that the learner may change: each a number, or one of several names"});
}

std::optional<Exercise> checked_exercise(const Scenario& scenario) {
  if (!scenario.has_exercise) return {};
  const Source& source = scenario.source;
  yaml::Problems problems = problems_of(source);
  yaml::Nodes nodes;
  const yaml::Node* root = build_tree(source, problems, nodes);
  yaml::Context context{problems, {}};
  const auto section = yaml::Keys({root, "", {}, &context}).find("exercise");
  Exercise exercise;
  yaml::MappingOf(read_exercise).read(*section, exercise);
  check_items(*section, scenario);
  problems.throw_if_any();
  return exercise;
}

}  // namespace bbsim::scenario
