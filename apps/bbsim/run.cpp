#include <CLI/App.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assemble.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "file/atomic_file.hpp"
#include "file/memory_table.hpp"
#include "file/outputs.hpp"
#include "model/model.hpp"
#include "record/recorder.hpp"
#include "replay_file.hpp"
#include "scenario/reader.hpp"
#include "simulation.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct RunArguments {
  ScenarioArguments scenario;
  std::string output, summary, error, replay;
};

constexpr file::ColumnHeader position_error{
    "position_error", "m", "estimate of the error of x and y: the larger one in this row"};

// Comes before any of them is opened.
void declare_files(const RunArguments& arguments, const Scenario& scenario,
                   const std::string& output) {
  file::Outputs outputs;
  reads_scenario(outputs, arguments.scenario.file, table_files(scenario));
  outputs.writes(output, arguments.output.empty() ? "its name by default, without -o" : "-o");
  if (!arguments.summary.empty()) outputs.writes(arguments.summary, "--summary");
  if (!arguments.replay.empty()) outputs.writes(arguments.replay, "--replay");
}

ExitCode run(const RunArguments& arguments, const Options& options) {
  if (!arguments.replay.empty()) require_replay_ending(arguments.replay, "--replay");
  std::vector<std::string> overrides = arguments.scenario.overrides;
  if (!arguments.error.empty()) overrides.push_back("solver.error=" + arguments.error);
  std::vector<file::InputTable> inputs;
  const Scenario scenario = read_scenario(arguments.scenario.file, overrides, &inputs);
  const auto asked = scenario::columns_named(scenario.output.columns);
  const auto columns = arguments.replay.empty() ? asked : with_pictured(asked, scenario);
  const model::Model model = assemble(scenario, columns);
  const solve::OutputGrid grid(scenario.time);

  const std::string output =
      arguments.output.empty() ? default_output(arguments.scenario.file, ".csv") : arguments.output;
  std::vector<file::ColumnHeader> headers;
  headers.reserve(asked.size());
  for (const scenario::Column* column : asked) {
    headers.push_back({column->name, column->unit, column->meaning});
  }
  declare_files(arguments, scenario, output);
  std::optional<ReplayFile> replay;
  if (!arguments.replay.empty()) replay.emplace(arguments.replay);
  const auto writer = file::open_table(output, headers);
  const auto summary_file =
      arguments.summary.empty() ? nullptr : std::make_unique<file::AtomicFile>(arguments.summary);
  writer->keep(inputs);
  std::optional<file::MemoryTable> pictured;
  if (replay) pictured.emplace(scenario::names_of(columns), writer.get(), asked.size());

  Simulation made =
      simulate(scenario, model, grid, columns, asked.size(),
               pictured ? static_cast<file::TableWriter&>(*pictured) : *writer, options.quiet);
  record::RunSummary& summary = made.summary;
  summary.output = output;
  if (summary.error_estimate) writer->add_column(position_error, made.row_estimates);
  writer->finish(record::to_attributes(summary, scenario.source.text));
  if (summary_file) {
    summary_file->write(record::to_json(summary));
    summary_file->commit();
  }

  tell(made, options.quiet);
  if (!options.quiet) {
    std::string line = name_of_output(output) + ": " + std::to_string(summary.rows) + " of " +
                       std::to_string(grid.size()) + " rows, " + summary.method + ", " +
                       std::to_string(summary.statistics.steps) + " steps";
    if (summary.error_estimate) {
      line += ", error about " + short_number(*summary.error_estimate) + " m";
    }
    say(line);
  }
  if (replay) {
    replay->write(scene_of(run_of(scenario, pictured->take(), summary)), options.quiet);
  }
  return made.code;
}

}  // namespace

void add_run(CLI::App& app, const Options& options, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("run", "Simulate a scenario");
  command->footer(
      "Examples:\n"
      "  bbsim run configs/fig2a.yaml\n"
      "  bbsim run configs/fig2a.yaml --set ball.radius=\"2 cm\" -o big.h5\n"
      "  bbsim run configs/fig2b.yaml --error \"1 um\" --summary run.json\n"
      "  bbsim run configs/rig.yaml -o - -q | head -3\n"
      "  bbsim run configs/rig.yaml -o rig.h5 --replay rig.html\n"
      "  sed 's/-10 cm/-5 cm/' configs/fig2a.yaml | bbsim run - -o near.csv");
  const auto arguments = std::make_shared<RunArguments>();
  add_scenario(*command, arguments->scenario);
  command
      ->add_option("-o,--output", arguments->output,
                   "FILE.csv, FILE.h5, or - for CSV on standard output; default: the scenario's "
                   "name with .csv, in the current folder (of standard input: -)")
      ->type_name("FILE");
  add_error(*command, arguments->error);
  command
      ->add_option("--summary", arguments->summary,
                   "FILE.json, or - for standard output: how the run went, what was modelled, "
                   "statistics")
      ->type_name("FILE");
  command
      ->add_option("--replay", arguments->replay,
                   "FILE.html: also a page that shows the run, or FILE.glb; as of bbsim replay")
      ->type_name("FILE");
  command->callback([arguments, &options, &chosen] {
    chosen = [arguments, &options] { return run(*arguments, options); };
  });
}

}  // namespace bbsim::app
