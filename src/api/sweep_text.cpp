// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/sweep_text.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "api/version.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "record/summary.hpp"
#include "simd/instruction_set.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::api {
namespace {

// Length of the longest word in bytes. HDF5 writes strings of one length many times faster.
constexpr std::size_t longest_status = 16;

std::string text_of(const Json& json) {
  return json_text(json, 1) + '\n';
}

// Accuracy of the cases, for comparisons; empty if it varies.
struct Accuracy {
  const char* name;
  double value;
};
std::vector<Accuracy> accuracy_of(const SweepFacts& facts) {
  const Solver& solver = facts.first.solver;
  for (const sweep::PlanAxis& axis : facts.task.plan.axes()) {
    if (axis.key.starts_with("solver")) return {};
  }
  if (solver.error) return {{"error_bound", *solver.error}};
  return {{"rtol", solver.rtol}, {"atol", solver.atol}};
}

Json plan_of(const SweepFacts& facts) {
  const auto& [family, sweep, task, first, shard] = facts;
  const Source& source = family.source();
  // Create objects and lists as such: nlohmann's json breaks a null that becomes one if memory runs
  // out at that moment.
  Json plan = Json::object();
  plan["version"] = version();
  plan["instruction_set"] = simd::name_of(simd::chosen_instruction_set());
  plan["scenario_text"] = source.text;
  plan["overrides"] = source.overrides;
  Json tables = Json::object(), vary = Json::array(), measures = Json::array();
  for (const auto& [name, hash] : family.table_hashes()) tables[name] = hash;
  if (!tables.empty()) plan["tables"] = std::move(tables);
  for (const Variation& variation : sweep.vary) {
    vary.push_back(variation.key + '=' + variation.spec);
  }
  plan["vary"] = std::move(vary);
  plan["combine"] = sweep.combine == Combine::zip ? "zip" : "grid";
  if (sweep.samples) {
    plan["samples"] = *sweep.samples;
    plan["seed"] = sweep.seed;
  }
  for (const scenario::Measure& measure : task.measures) measures.push_back(measure.name);
  plan["measure"] = std::move(measures);
  for (const scenario::Expectation& expectation : task.expectations)
    plan["expect"].push_back(expectation.text);
  plan["trajectories"] = !task.series.empty();
  plan["cases"] = task.plan.cases();
  if (shard.of > 1) plan["shard"] = std::to_string(shard.number) + '/' + std::to_string(shard.of);
  return plan;
}

}  // namespace

sweep::CaseFileLayout layout_of(const SweepFacts& facts, sweep::CaseRange range) {
  const sweep::SweepTask& task = facts.task;
  sweep::CaseFileLayout layout;
  using file::Hdf5Kind;
  layout.inputs = facts.family.inputs();
  layout.range = range;
  layout.is_shard = facts.shard.of > 1;
  layout.columns.push_back({"case", "1", "number of the case, from 0"});
  for (const sweep::PlanAxis& axis : task.plan.axes()) {
    layout.columns.push_back({axis.key,
                              std::string(facts.family.unit_of(axis.key, task.plan.settings(0))),
                              "varied key of the scenario, in SI units and radians",
                              axis.numeric ? Hdf5Kind::number : Hdf5Kind::text});
  }
  layout.columns.push_back(
      {"status", "", "how the case ended, in one word", Hdf5Kind::text, longest_status});
  layout.columns.push_back({"reason", "", "why it ended early, or empty", Hdf5Kind::text});
  layout.columns.push_back({"end_time", "s", "time reached"});
  for (const scenario::Measure& measure : task.measures) {
    layout.columns.push_back({measure.name, measure.unit(), measure.meaning()});
  }
  for (const scenario::Expectation& expectation : task.expectations) {
    layout.columns.push_back({"expect: " + expectation.text, "1", "1 if it holds, 0 if not"});
  }
  if (task.series.empty()) return layout;
  const solve::OutputGrid grid(facts.first.time);
  layout.axis = {"t", "s", "time"};
  for (std::size_t i = 0; i < grid.size(); ++i) layout.axis_values.push_back(grid[i]);
  for (const scenario::Column* column : task.series) {
    layout.columns.push_back({std::string(column->name), std::string(column->unit),
                              std::string(column->meaning), Hdf5Kind::series, grid.size()});
  }
  return layout;
}

std::string plan_text(const SweepFacts& facts) {
  return text_of(plan_of(facts));
}

file::Attributes attributes_of(const SweepFacts& facts, const sweep::Engine& engine) {
  const Json plan = plan_of(facts);
  const std::filesystem::path file(facts.family.source().file);
  file::Attributes attributes;
  const auto take = [&](const char* name) {
    attributes.emplace_back(name, record::attribute_of(plan[name]));
  };
  take("version");
  take("instruction_set");
  attributes.emplace_back("engine", engine.name);
  attributes.emplace_back("scenario", file.filename().string());
  for (const char* name : {"scenario_text", "overrides", "vary"}) take(name);
  for (const auto& [name, value] : accuracy_of(facts)) attributes.emplace_back(name, value);
  take("cases");
  take("combine");
  if (facts.sweep.samples) {
    attributes.emplace_back("samples", static_cast<std::int64_t>(*facts.sweep.samples));
    attributes.emplace_back("seed", static_cast<std::int64_t>(facts.sweep.seed));
  }
  return attributes;
}

// The command that runs a case alone.
static std::string repeat_command(const SweepFacts& facts, std::size_t number) {
  const Source& source = facts.family.source();
  std::string command = "bbsim run " + shell_word(source.file);
  for (const std::string& override_ : source.overrides) {
    command += " --set " + shell_word(override_);
  }
  for (const ScenarioFamily::Setting& setting : facts.task.plan.settings(number)) {
    command += " --set " + shell_word(setting.key + '=' + setting.value);
  }
  return command;
}

std::string repeat_text(const SweepFacts& facts, const sweep::FailedCase& failed) {
  const std::string reason = failed.reason.empty() ? "" : " (" + failed.reason + ')';
  return "case " + std::to_string(failed.number) + " is " + failed.status + reason +
         "; repeat it with\n  " + repeat_command(facts, failed.number);
}

std::string summary_text(const SweepFacts& facts, const SweepResult& result) {
  Json summary = Json::object();
  summary["status"] = result.code == ExitCode::interrupted ? "interrupted" : "done";
  summary["scenario"] = facts.family.source().file;
  summary["output"] = result.output;
  summary["engine"] = result.engine;
  for (const auto& [name, value] : accuracy_of(facts)) summary[name] = value;
  summary["rows"] = result.rows;
  Json& statuses = summary["statuses"] = Json::object();
  for (const auto& [word, count] : result.statuses.words) statuses[word] = count;
  Json& failed = summary["failed"] = Json::array();
  for (const sweep::FailedCase& failed_case : result.statuses.failed) {
    failed.push_back({{"case", failed_case.number},
                      {"status", failed_case.status},
                      {"reason", failed_case.reason},
                      {"command", repeat_command(facts, failed_case.number)}});
  }
  for (std::size_t i = 0; i < facts.task.expectations.size(); ++i) {
    const auto& unmet = result.statuses.unmet;
    summary["expectations"].push_back({{"text", facts.task.expectations[i].text},
                                       {"cases_unmet", i < unmet.size() ? unmet[i] : 0}});
  }
  const Json plan = plan_of(facts);
  for (const auto& [name, value] : plan.items()) summary[name] = value;
  return text_of(summary);
}

}  // namespace bbsim::api
