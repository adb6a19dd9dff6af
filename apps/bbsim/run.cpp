#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "describe.hpp"
#include "model/model.hpp"
#include "progress.hpp"
#include "record/recorder.hpp"
#include "record/summary.hpp"
#include "scenario/reader.hpp"
#include "signals.hpp"
#include "solve/choose.hpp"
#include "solve/cpu_clock.hpp"
#include "solve/integrate.hpp"

namespace bbsim::app {
namespace {

struct RunArguments {
  std::string scenario, output, summary;
  std::vector<std::string> overrides;
};

std::string default_output(const std::string& scenario) {
  return std::filesystem::path(scenario).stem().string() + ".csv";
}

const char* status_name(solve::Ending ending) {
  switch (ending) {
    case solve::Ending::done:
      return "done";
    case solve::Ending::failed:
      return "failed";
    case solve::Ending::interrupted:
      return "interrupted";
  }
  return "";
}

ExitCode exit_code(solve::Ending ending) {
  switch (ending) {
    case solve::Ending::done:
      return ExitCode::done;
    case solve::Ending::failed:
      return ExitCode::ended_early;
    case solve::Ending::interrupted:
      return ExitCode::interrupted;
  }
  return ExitCode::ended_early;
}

record::RunSummary summarise(const Scenario& scenario, const model::Model& model,
                             const solve::Outcome& outcome, const std::string& reason,
                             const std::string& output, double cpu_seconds) {
  record::RunSummary summary;
  summary.version = BBSIM_VERSION;
  summary.scenario = scenario.source.file;
  summary.title = scenario.title;
  summary.overrides = scenario.source.overrides;
  summary.status = status_name(outcome.ending);
  summary.reason = reason;
  summary.end_time = outcome.reached;
  summary.rows = outcome.rows;
  summary.output = output;
  summary.states = model.state_names();
  for (const model::Note& note : model.notes) {
    summary.model_notes.push_back(note.part + ": " + note.reason);
  }
  summary.method = solve::method_name(outcome.method);
  summary.rtol = scenario.solver.rtol;
  summary.atol = scenario.solver.atol;
  summary.statistics = {outcome.statistics.steps,
                        outcome.statistics.rhs_evaluations,
                        outcome.statistics.jacobian_evaluations,
                        outcome.statistics.nonlinear_iterations,
                        outcome.statistics.error_test_failures,
                        cpu_seconds};
  return summary;
}

ExitCode run(const RunArguments& arguments, const Options& options) {
  const Scenario scenario = read_scenario(arguments.scenario, arguments.overrides);
  const auto columns = record::columns_named(scenario.output.columns);
  const model::Model model =
      model::assemble(scenario, record::any_needs(columns, record::Needs::gamma));
  const solve::OutputGrid grid(scenario.time);

  const std::string output =
      arguments.output.empty() ? default_output(arguments.scenario) : arguments.output;
  std::vector<record::ColumnHeader> headers;
  for (const record::Column* column : columns) {
    headers.push_back({column->name, column->unit, column->meaning});
  }
  const auto writer = record::open_table(output, std::move(headers));
  record::Recorder recorder(model, {scenario.ball.radius, scenario.ball.mass, scenario.gravity},
                            grid, columns, *writer);

  Progress progress(arguments.scenario, options.quiet);
  const solve::Watch watch{&watch_signals(),
                           [&](double time) { progress.update(time / grid.end()); }};
  const solve::CpuClock clock;
  const solve::Outcome outcome =
      solve::integrate(model, scenario.solver.method, {scenario.solver.rtol, scenario.solver.atol},
                       grid, recorder, watch);
  const double cpu_seconds = clock.seconds();
  progress.clear();

  std::string reason;
  if (outcome.ending == solve::Ending::failed) {
    reason = failure_text(model, outcome, grid.end());
  } else if (outcome.ending == solve::Ending::interrupted) {
    reason = "interrupted at t = " + short_number(outcome.reached) + " s of " +
             short_number(grid.end()) + " s.";
  }
  const record::RunSummary summary =
      summarise(scenario, model, outcome, reason, output, cpu_seconds);
  writer->finish(record::to_attributes(summary, scenario.source.text));
  if (!arguments.summary.empty()) record::write_summary(arguments.summary, summary);

  if (!options.quiet) {
    if (!reason.empty()) std::fprintf(stderr, "%s\n", reason.c_str());
    std::fprintf(stderr, "%s: %zu of %zu rows, %s, %zu steps\n", output.c_str(), outcome.rows,
                 grid.size(), summary.method.c_str(), outcome.statistics.steps);
  }
  return exit_code(outcome.ending);
}

}  // namespace

void add_run(CLI::App& app, const Options& options, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("run", "Simulate a scenario");
  command->fallthrough();
  const auto arguments = std::make_shared<RunArguments>();
  command->add_option("SCENARIO", arguments->scenario, "YAML scenario")->required();
  command->add_option("-o,--output", arguments->output,
                      "FILE.csv, FILE.h5, or - for CSV on standard output; default: the scenario's "
                      "name with .csv, in the current folder");
  command
      ->add_option("--set", arguments->overrides,
                   "key.path=value: set a key of the scenario; may be given again")
      ->take_all()
      ->expected(1);
  command->add_option("--summary", arguments->summary,
                      "FILE.json: how the run went, what was modelled, statistics");
  command->callback([arguments, &options, &chosen] {
    chosen = [arguments, &options] { return run(*arguments, options); };
  });
}

}  // namespace bbsim::app
