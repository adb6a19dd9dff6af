// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assemble.hpp"
#include "base/number_text.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/memory_table.hpp"
#include "file/outputs.hpp"
#include "measure_text.hpp"
#include "model/model.hpp"
#include "replay_file.hpp"
#include "run_part.hpp"
#include "scenario/expectation.hpp"
#include "scenario/reader.hpp"
#include "signals.hpp"
#include "simulation.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct RunArguments {
  ScenarioArguments scenario;
  std::string output, summary, error, replay;
  bool force = false;
  std::vector<std::string> measures, expect;
  PartArguments part;
};

file::ColumnHeader header_of(const scenario::Column& column) {
  return {column.name, column.unit, column.meaning};
}

// Comes before any of them is opened.
void declare_files(const RunArguments& arguments, const Scenario& scenario,
                   const std::string& output, const std::optional<RunPart>& part) {
  file::Outputs outputs;
  reads_scenario(outputs, arguments.scenario.file, scenario);
  if (part) part->declare_read(outputs);
  if (!arguments.measures.empty()) {
    // A pipe is nobody's, but what came of it could not be read.
    for (const auto& [name, option] : {std::pair(output, "-o"), {arguments.summary, "--summary"}}) {
      if (name != "-") continue;
      throw InputError("--measure: prints to standard output, as " + std::string(option) +
                       " - does; allowed: " + option + " FILE");
    }
    prints(outputs);
  }
  outputs.writes(output, arguments.output.empty() ? "its name by default, without -o" : "-o");
  if (part) part->declare_written(outputs);
  if (!arguments.summary.empty()) outputs.writes(arguments.summary, "--summary");
  if (!arguments.replay.empty()) declare_replay(outputs, arguments.replay, "--replay");
}

std::vector<scenario::Expectation> expectations_of(const RunArguments& arguments,
                                                   const Scenario& scenario) {
  std::vector<scenario::Expectation> expectations;
  for (const std::string& text : arguments.expect) {
    expectations.push_back(scenario::read_expectation("--expect", text, scenario));
  }
  return expectations;
}

// The measures asked for, and behind them the others that something is expected of.
std::vector<scenario::Measure> with_expected(
    std::vector<scenario::Measure> measures,
    const std::vector<scenario::Expectation>& expectations) {
  for (const scenario::Expectation& one : expectations) {
    if (std::ranges::find(measures, one.measure.name, &scenario::Measure::name) == measures.end()) {
      measures.push_back(one.measure);
    }
  }
  return measures;
}

// What became of the expectations; those that are not met are said.
void judge(const std::vector<scenario::Expectation>& expectations,
           const std::vector<scenario::Measure>& measures, Simulation& made) {
  for (const scenario::Expectation& one : expectations) {
    const auto at = static_cast<std::size_t>(
        std::ranges::find(measures, one.measure.name, &scenario::Measure::name) - measures.begin());
    const double value = made.measures[at];
    const bool holds = one.holds(value);
    made.summary.expectations.push_back({one.text, value, holds});
    if (holds) continue;
    const std::string unit = one.measure.unit();
    const char* const why = made.whys[at];
    made.unmet.push_back("not as expected: " + one.text + ": " + one.measure.name + " is " +
                         (std::isnan(value)
                              ? "no number" + (why != nullptr ? std::string(": ") + why : "")
                              : number_text(value) + (unit == "1" ? "" : ' ' + unit)));
    if (made.code == ExitCode::done) made.code = ExitCode::ended_early;
  }
}

ExitCode run(const RunArguments& arguments, const Options& options) {
  if (!arguments.replay.empty()) require_replay_ending(arguments.replay, "--replay");
  say_if_waiting(arguments.scenario.file, "a scenario", options.quiet);
  std::vector<std::string> overrides = arguments.scenario.overrides;
  if (!arguments.error.empty()) overrides.push_back("solver.error=" + arguments.error);
  std::vector<file::InputTable> inputs;
  const Scenario scenario = read_scenario(arguments.scenario.file, overrides, &inputs);
  const auto asked = scenario::columns_named(scenario.output.columns);
  const auto columns = arguments.replay.empty() ? asked : with_pictured(asked, scenario);
  const auto printed =
      scenario::measures_named(scenario::split_measures(arguments.measures), scenario);
  const auto expectations = expectations_of(arguments, scenario);
  const auto measures = with_expected(printed, expectations);
  const std::string output =
      arguments.output.empty() ? default_output(arguments.scenario.file, ".csv") : arguments.output;
  std::optional<RunPart> part;
  if (arguments.part.any()) part.emplace(arguments.part, scenario, inputs);
  declare_files(arguments, scenario, output, part);
  std::vector<file::ColumnHeader> headers;
  headers.reserve(asked.size());
  for (const scenario::Column* column : asked) headers.push_back(header_of(*column));
  // Before a controller is started, and long before the file is opened.
  file::require_table_name(output);
  if (arguments.output.empty() && !arguments.force) {
    file::require_like(output, file::table_with(file::csv_header(headers)));
  }
  controller::Host host = make_host(&watch_signals());
  auto needed = columns;
  for (const scenario::Measure& measure : measures) {
    needed.push_back(measure.column);
    if (measure.instant.column != nullptr) needed.push_back(measure.instant.column);
  }
  const model::Model model = assemble(part ? part->whole() : scenario, needed, host);
  const solve::OutputGrid grid = part ? part->grid() : solve::OutputGrid(scenario.time);
  if (part) part->check(model, columns);

  std::deque<std::string> units;  // as the scene's own controller names them
  for (std::size_t c = 0; c < asked.size(); ++c) {
    if (asked[c]->needs != scenario::Needs::own) continue;
    units.push_back(host.unit_of(asked[c]->name).value_or("1"));
    headers[c].unit = units.back();
  }
  if (part) part->open();
  std::optional<ReplayFile> replay;
  if (!arguments.replay.empty()) replay.emplace(arguments.replay);
  const auto writer = file::open_table(output, headers);
  const auto summary_file =
      arguments.summary.empty() ? nullptr : std::make_unique<file::AtomicFile>(arguments.summary);
  writer->keep(inputs);
  std::optional<file::MemoryTable> pictured;
  if (replay) pictured.emplace(scenario::names_of(columns), writer.get(), asked.size());

  const auto simulation = [&] {
    return simulate(scenario, model, grid, {columns, asked.size(), measures},
                    pictured ? static_cast<file::TableWriter&>(*pictured) : *writer, options.quiet,
                    part ? &part->part() : nullptr);
  };
  Simulation made = part ? part->going_on(simulation) : simulation();
  record::RunSummary& summary = made.summary;
  summary.output = output;
  for (std::size_t m = 0; m < printed.size(); ++m) {
    summary.measures.emplace_back(printed[m].name, made.measures[m]);
  }
  judge(expectations, measures, made);
  if (summary.error_estimate)
    writer->add_column(header_of(scenario::position_error), made.row_estimates);
  // A controller that does not begin is no reason to lose an earlier run.
  const bool any_rows = summary.rows > 0;
  if (any_rows) writer->finish(record::to_attributes(summary, scenario.source.text));
  if (summary_file) {
    summary_file->write(record::to_json(summary));
    summary_file->commit();
  }

  host.finish();
  if (!printed.empty()) print(measure_text(printed, made.measures));
  const std::string state = part ? part->finish(model) : "";
  const std::size_t rows = part ? part->part().end_row - part->part().first_row : grid.size();
  tell(made, options.quiet);
  if (!options.quiet && !any_rows) {
    say(name_of_output(output) + ": not written; there are no rows");
  } else if (!options.quiet) {
    std::string line = name_of_output(output) + ": " + std::to_string(summary.rows) + " of " +
                       std::to_string(rows) + " rows, " + summary.method + ", " +
                       std::to_string(summary.statistics.steps) + " steps";
    if (summary.error_estimate) {
      line += ", error about " + short_number(*summary.error_estimate) + " m";
    }
    say(line);
  }
  if (!state.empty() && !options.quiet) say(state);
  if (replay && any_rows) {
    replay->write(scene_of(run_of(scenario, pictured->take(), made)), options.quiet);
  }
  return made.code;
}

}  // namespace

void add_run(Command& command, const Options& options) {
  command.footer(
      measures_footer() +
      "\n\nExamples:\n"
      "  bbsim run configs/step.yaml --measure x.RiseTime,x.Overshoot,max_tilt\n"
      "  bbsim run configs/rig.yaml --expect \"rms_tracking_error from 5 s < 0.5 mm\" -q\n"
      "  bbsim run configs/fig2a.yaml\n"
      "  bbsim run configs/fig2a.yaml --set ball.radius=\"2 cm\" -o big.h5\n"
      "  bbsim run configs/fig2b.yaml --error \"1 um\" --summary run.json\n"
      "  bbsim run configs/rig.yaml -o - -q | head -3\n"
      "  bbsim run configs/rig.yaml --until \"20 s\" --save-state rig.state -o first.csv\n"
      "  bbsim run configs/rig.yaml --from-state rig.state -o second.csv\n"
      "  bbsim run configs/rig.yaml -o rig.h5 --replay rig.html\n"
      "  sed 's/-10 cm/-5 cm/' configs/fig2a.yaml | bbsim run - -o near.csv");
  const auto arguments = std::make_shared<RunArguments>();
  add_scenario(command, arguments->scenario);
  command
      .option("-o,--output", arguments->output,
              "write rows to FILE.csv or FILE.h5, or - for CSV on standard output; default: "
              "SCENARIO's name with .csv, in the current folder; if SCENARIO is -, standard output")
      .takes("FILE");
  add_force(command, arguments->force);
  add_error(command, arguments->error);
  add_measures(command, arguments->measures,
               "print measures of the motion as CSV, measure,value (see below); repeatable");
  command
      .option("--expect", arguments->expect,
              "exit with code 1 if this does not hold, such as \"max_tilt < 5 deg\"; any measure, "
              "with <, <=, > or >=; repeatable")
      .takes("\"MEASURE < VALUE\"")
      .may_be_repeated();
  command
      .option("--summary", arguments->summary,
              "write a summary of the run to FILE.json, or - for standard output: how it ended, "
              "the model, statistics")
      .takes("FILE");
  add_part(command, arguments->part);
  command
      .option("--replay", arguments->replay, "also write FILE.html or FILE.glb, like bbsim replay")
      .takes("FILE");
  command.does([arguments, &options] {
    return with_error_option(arguments->error, [&] { return run(*arguments, options); });
  });
}

}  // namespace bbsim::app
