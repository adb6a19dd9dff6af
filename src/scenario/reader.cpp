// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/reader.hpp"

#include <filesystem>

#include "scenario/exercise.hpp"
#include "scenario/sections.hpp"
#include "yaml/document.hpp"
#include "yaml/override.hpp"
#include "yaml/rules.hpp"
#include "yaml/text_file.hpp"

namespace bbsim {
namespace scenario {

using namespace yaml;

// Reads `time` before `gimbal` and the ball's push, because their tables must cover the run.
void read_sections(Keys& keys, Scenario& scenario) {
  keys.optional("title", Text{"a text", true}, scenario.title,
                {"any text, for reports and pictures"});
  keys.optional("gravity", Number{Dimension::acceleration, {.at_least = 0}}, scenario.gravity,
                {"acceleration of gravity"});
  keys.section("ball", read_ball, scenario.ball, {"[ball](#ball)"});
  keys.section("plate", read_plate, scenario.plate, {"[plate](#plate)"});
  keys.section("time", read_time, scenario.time,
               {"[time, solver and output](#time-solver-and-output)"});
  read_ball_push(keys, scenario.ball);
  keys.section("gimbal", read_gimbal, scenario.gimbal, {"what moves the plate: [gimbal](#gimbal)"});
  keys.optional("controller", MappingOf(read_controller), scenario.controller,
                {"a closed loop: [controller](#controller)"});
  keys.section("events", read_events, scenario.events,
               {.meaning = "what bbsim watches for: [events](#events)", .standard = "none"});
  keys.section("solver", read_solver, scenario.solver, {"the same section"});
  keys.section("output", read_output, scenario.output, same);
  keys.section("sweep", read_sweep, scenario.sweep,
               {.meaning = "defaults of `bbsim sweep`: [sweep](#sweep)", .standard = "none"});
  std::optional<Exercise> exercise;  // only `check` and pages look at it
  keys.optional("exercise", MappingOf(read_exercise), exercise,
                {"tasks for a learner: [exercise](#exercise)"});
  scenario.has_exercise = exercise.has_value();
  scenario.tables = keys.context().table_files;
  place_groove(scenario);
  check_rig(keys.mapping(), scenario);
}

Problems problems_of(const Source& source, std::vector<std::string> settings) {
  return {source.file, without_byte_order_mark(source.text), source.overrides, std::move(settings)};
}

const Node* build_tree(const Source& source, Problems& problems, Nodes& nodes) {
  const Node* root = nullptr;
  try {
    root = parse_yaml(check_text(source.text, 0), 0, nodes);
    if (root == nullptr) {
      throw TextFault({}, "found an empty file; allowed: " + MappingOf(read_sections).allowed());
    }
  } catch (const TextFault& fault) {
    problems.add(fault.position, fault.what());
    return nullptr;
  }
  for (std::size_t i = 0; i < source.overrides.size(); ++i) {
    try {
      root = apply_override(source.overrides[i], static_cast<int>(i) + 1, *root, nodes);
    } catch (const TextFault& fault) {
      problems.add(fault.position, fault.what());
    }
  }
  return root;
}

}  // namespace scenario

using namespace scenario;

namespace {

void read_into(Scenario& scenario, Problems& problems, std::vector<file::InputTable>* inputs) {
  Nodes nodes;
  if (const Node* root = build_tree(scenario.source, problems, nodes)) {
    Context context{problems, std::filesystem::path(scenario.source.file).parent_path()};
    MappingOf(read_sections).read({root, "", {}, &context}, scenario);
    if (inputs != nullptr) *inputs = context.tables->all();
  }
}

}  // namespace

Scenario parse_scenario(const std::string& text, const std::string& name,
                        const std::vector<std::string>& overrides,
                        std::vector<file::InputTable>* inputs) {
  Scenario scenario;
  scenario.source = {name, text, overrides};
  Problems problems = problems_of(scenario.source);
  read_into(scenario, problems, inputs);
  problems.throw_if_any();
  scenario.remarks = problems.remarks();
  return scenario;
}

std::string place_of(const Source& source, std::string_view key) {
  Problems problems = problems_of(source);
  Nodes nodes;
  const Node* const root = build_tree(source, problems, nodes);
  Context context{problems, {}};
  while (root != nullptr && !key.empty()) {
    if (const auto found = Value{root, "", {}, &context}.at(key)) {
      return problems.where(found->position);
    }
    const std::size_t dot = key.rfind('.');
    key = key.substr(0, dot == std::string_view::npos ? 0 : dot);
  }
  return problems.where({});
}

std::optional<double> number_at(const Source& source, std::string_view key, Dimension dimension) {
  Problems unheard = problems_of(source);
  Nodes nodes;
  const Node* const root = build_tree(source, unheard, nodes);
  Context context{unheard, {}};
  const auto found = root == nullptr ? std::nullopt : Value{root, "", {}, &context}.at(key);
  if (!found || found->node->kind != Node::Kind::scalar) return {};
  return read_quantity(found->node->text, found->node->quoted, dimension).value;
}

Scenario parse_sound_parts(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides) {
  Scenario scenario;
  scenario.source = {name, text, overrides};
  Problems unheard = problems_of(scenario.source);
  read_into(scenario, unheard, nullptr);
  return scenario;
}

Scenario read_scenario(const std::string& file, const std::vector<std::string>& overrides,
                       std::vector<file::InputTable>* inputs) {
  return parse_scenario(read_text(file), name_in_messages(file), overrides, inputs);
}

}  // namespace bbsim
