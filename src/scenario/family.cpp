// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/family.hpp"

#include <filesystem>
#include <map>

#include "base/fnv1a.hpp"
#include "scenario/sections.hpp"
#include "yaml/override.hpp"
#include "yaml/rules.hpp"
#include "yaml/spelling.hpp"
#include "yaml/text_file.hpp"

namespace bbsim {

using namespace yaml;
using namespace scenario;

struct ScenarioFamily::State {
  Source source;
  Nodes nodes;
  const Node* root = nullptr;
  std::shared_ptr<Tables> tables = std::make_shared<Tables>();
  std::optional<ControllerFactory> controller;

  Scenario read(const std::vector<Setting>& settings,
                std::map<std::string, NotedNumber>* numbers) const;
};

ScenarioFamily::ScenarioFamily(const std::string& file, const std::vector<std::string>& overrides)
    : ScenarioFamily(Source{name_in_messages(file), read_text(file), overrides}) {}

ScenarioFamily::ScenarioFamily(const Source& source) : state_(std::make_unique<State>()) {
  state_->source = source;
  Problems problems = problems_of(state_->source);
  state_->root = build_tree(state_->source, problems, state_->nodes);
  problems.throw_if_any();
}

ScenarioFamily::~ScenarioFamily() = default;
ScenarioFamily::ScenarioFamily(ScenarioFamily&&) noexcept = default;

Scenario ScenarioFamily::State::read(const std::vector<Setting>& settings,
                                     std::map<std::string, NotedNumber>* numbers) const {
  std::vector<std::string> labels;
  for (const Setting& setting : settings) labels.push_back(setting.key + '=' + setting.value);
  Problems problems = problems_of(source, std::move(labels));
  Nodes own;
  const Node* tree = root;
  int number = static_cast<int>(source.overrides.size());
  for (const Setting& setting : settings) {
    try {
      tree = apply_override(setting.key, setting.value, ++number, *tree, own);
    } catch (const TextFault& fault) {
      problems.add(fault.position, fault.what());
    }
  }
  Scenario scenario;
  Context context{problems, std::filesystem::path(source.file).parent_path(), {}, tables, {},
                  numbers};
  MappingOf(read_sections).read({tree, "", {}, &context}, scenario);
  problems.throw_if_any();
  scenario.remarks = problems.remarks();
  if (controller && scenario.controller && scenario.controller->own) {
    scenario.controller->own->by = *controller;
  }
  return scenario;
}

void ScenarioFamily::give_controller(ControllerFactory factory) {
  state_->controller = std::move(factory);
}

Scenario ScenarioFamily::read(const std::vector<Setting>& settings) const {
  return state_->read(settings, nullptr);
}

Scenario ScenarioFamily::itself() const {
  Scenario scenario = read({});
  scenario.source = source();
  return scenario;
}

std::optional<double> ScenarioFamily::number_at(const std::string& key,
                                                const std::vector<Setting>& settings) const {
  std::map<std::string, NotedNumber> numbers;
  [[maybe_unused]] const Scenario scenario = state_->read(settings, &numbers);
  const auto found = numbers.find(american(key));
  if (found == numbers.end()) return {};
  return found->second.value;
}

std::string_view ScenarioFamily::unit_of(const std::string& key,
                                         const std::vector<Setting>& settings) const {
  std::map<std::string, NotedNumber> numbers;
  [[maybe_unused]] const Scenario scenario = state_->read(settings, &numbers);
  const auto found = numbers.find(american(key));
  return found == numbers.end() ? "" : si_unit(found->second.dimension);
}

std::string ScenarioFamily::text_at(const std::string& key) const {
  const auto found = Value{state_->root, "", {}, nullptr}.at(key);
  return !found || found->node->kind == Node::Kind::null ? "" : flow_text(*found->node);
}

Sweep ScenarioFamily::read_sweep() const {
  Problems problems = problems_of(state_->source);
  Sweep sweep;
  if (state_->root->kind == Node::Kind::mapping) {
    Context context{problems, {}};
    Keys keys({state_->root, "", {}, &context});
    keys.section("sweep", scenario::read_sweep, sweep);
  }
  problems.throw_if_any();
  return sweep;
}

std::vector<std::pair<std::string, std::uint64_t>> ScenarioFamily::table_hashes() const {
  const std::lock_guard lock(state_->tables->mutex);
  std::vector<std::pair<std::string, std::uint64_t>> hashes;
  for (const auto& [file, table] : state_->tables->by_file) {
    std::uint64_t hash = fnv1a_start;
    for (const auto& column : table.data->columns) {
      for (const double value : column.numbers) hash = fnv1a(hash, value);
    }
    hashes.emplace_back(file, hash);
  }
  return hashes;
}

std::vector<file::InputTable> ScenarioFamily::inputs() const {
  return state_->tables->all();
}

const Source& ScenarioFamily::source() const {
  return state_->source;
}

}  // namespace bbsim
