#include <CLI/App.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assemble.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "model/explain.hpp"
#include "model/model.hpp"
#include "progress.hpp"
#include "record/atomic_file.hpp"
#include "record/edge_note.hpp"
#include "record/outputs.hpp"
#include "record/recorder.hpp"
#include "record/summary.hpp"
#include "scenario/reader.hpp"
#include "signals.hpp"
#include "solve/choose.hpp"
#include "solve/collocation/radau.hpp"
#include "solve/cpu_clock.hpp"
#include "solve/integrate.hpp"
#include "study/error_control.hpp"
#include "terminal.hpp"
#include "warnings.hpp"

namespace bbsim::app {
namespace {

struct RunArguments {
  ScenarioArguments scenario;
  std::string output, summary, error;
};

const char* status_name(solve::Ending ending) {
  switch (ending) {
    case solve::Ending::done:
      return "done";
    case solve::Ending::failed:
      return "failed";
    case solve::Ending::interrupted:
      return "interrupted";
    case solve::Ending::stopped:
      return "stopped";
  }
  return "";
}

ExitCode exit_code(solve::Ending ending) {
  switch (ending) {
    case solve::Ending::done:
      return ExitCode::done;
    case solve::Ending::failed:
    case solve::Ending::stopped:
      return ExitCode::ended_early;
    case solve::Ending::interrupted:
      return ExitCode::interrupted;
  }
  return ExitCode::ended_early;
}

// What was integrated, and how well, as far as the run can tell.
struct Integration {
  solve::Outcome outcome;
  solve::Tolerances tolerances;
  std::optional<double> error_estimate;  // m, of a run with solver.error
  std::vector<double> row_estimates;     // the same of each row
  bool within_error = true;
  double cpu_seconds = 0;
};

Integration integrate(const Scenario& scenario, const model::Model& model,
                      const solve::OutputGrid& grid, solve::StateSink& sink,
                      const solve::Watch& watch) {
  const solve::CpuClock clock;
  const Solver& solver = scenario.solver;
  Integration made;
  if (solver.error) {
    study::ErrorControlled run =
        study::integrate_to_error(model, solver.method, *solver.error, grid, sink, watch);
    made = {std::move(run.outcome), run.tolerances, {}, {}, true, 0};
    if (made.outcome.ending == solve::Ending::done ||
        made.outcome.ending == solve::Ending::stopped) {
      made.error_estimate = run.estimate;
      made.row_estimates = std::move(run.row_estimates);
      made.within_error = run.met;
    }
  } else {
    made.tolerances = {solver.rtol, solver.atol};
    made.outcome = solve::integrate(model, solver.method, made.tolerances, grid, sink, watch);
  }
  made.cpu_seconds = clock.seconds();
  return made;
}

constexpr record::ColumnHeader position_error{
    "position_error", "m", "estimate of the error of x and y: the larger one in this row"};

// Why the run is not all that was asked for; empty if it is.
std::string shortfall(const Scenario& scenario, const model::Model& model,
                      const Integration& made) {
  const double end = scenario.time.end;
  switch (made.outcome.ending) {
    case solve::Ending::failed:
      return failure_text(scenario, model, made.outcome);
    case solve::Ending::interrupted:
      return "interrupted at t = " + short_number(made.outcome.reached) + " s of " +
             short_number(end) + " s.";
    case solve::Ending::stopped:
      return "the run stopped at t = " + short_number(made.outcome.reached) + " s of " +
             short_number(end) + " s: " + occurrence_text(made.outcome.occurrences.back()) +
             ".\n  " + stopping_text(scenario, made.outcome.occurrences.back().name);
    case solve::Ending::done:
      break;
  }
  if (made.within_error) return "";
  return "an error of " + short_number(*scenario.solver.error) +
         " m is out of reach: the scene amplifies rounding, and double precision gives about " +
         short_number(*made.error_estimate) +
         " m.\n  Ask for that, or end the scene earlier. The rows are those of the best run.";
}

record::RunSummary summarise(const Scenario& scenario, const model::Model& model,
                             const Integration& made, const std::string& reason,
                             const std::vector<std::string>& warnings, const std::string& output,
                             const std::optional<record::MotorPeaks>& peaks) {
  const solve::Outcome& outcome = made.outcome;
  record::RunSummary summary;
  summary.version = BBSIM_VERSION;
  summary.instruction_set = solve::collocation::choose_kernels().name;
  summary.scenario = scenario.source.file;
  summary.scenario_text = scenario.source.text;
  summary.title = scenario.title;
  summary.overrides = scenario.source.overrides;
  summary.status = status_name(outcome.ending);
  summary.reason = reason;
  summary.warnings = warnings;
  summary.end_time = outcome.reached;
  summary.rows = outcome.rows;
  summary.output = output;
  summary.states = model.state_names();
  for (const model::Note& note : model::explain(scenario, model)) {
    summary.model_notes.push_back(note.part + ": " + note.reason);
  }
  summary.method = solve::method_name(outcome.method);
  summary.rtol = made.tolerances.rtol;
  summary.atol = made.tolerances.atol;
  summary.error_bound = scenario.solver.error;
  summary.error_estimate = made.error_estimate;
  for (const model::Occurrence& event : outcome.occurrences) {
    summary.events.push_back(record::event_record(event));
  }
  summary.peaks = peaks;
  summary.statistics = {outcome.statistics.steps,
                        outcome.statistics.rhs_evaluations,
                        outcome.statistics.jacobian_evaluations,
                        outcome.statistics.nonlinear_iterations,
                        outcome.statistics.error_test_failures,
                        made.cpu_seconds};
  return summary;
}

// Before any of them is opened.
void declare_files(const RunArguments& arguments, const Scenario& scenario,
                   const std::string& output) {
  record::Outputs outputs;
  reads_scenario(outputs, arguments.scenario.file, table_files(scenario));
  outputs.writes(output, arguments.output.empty() ? "its name by default, without -o" : "-o");
  if (!arguments.summary.empty()) outputs.writes(arguments.summary, "--summary");
}

ExitCode run(const RunArguments& arguments, const Options& options) {
  std::vector<std::string> overrides = arguments.scenario.overrides;
  if (!arguments.error.empty()) overrides.push_back("solver.error=" + arguments.error);
  std::vector<record::InputTable> inputs;
  const Scenario scenario = read_scenario(arguments.scenario.file, overrides, &inputs);
  const auto columns = record::columns_named(scenario.output.columns);
  const model::Model model = assemble(scenario, columns);
  const solve::OutputGrid grid(scenario.time);

  const std::string output =
      arguments.output.empty() ? default_output(arguments.scenario.file, ".csv") : arguments.output;
  std::vector<record::ColumnHeader> headers;
  headers.reserve(columns.size());
  for (const record::Column* column : columns) {
    headers.push_back({column->name, column->unit, column->meaning});
  }
  declare_files(arguments, scenario, output);
  const auto writer = record::open_table(output, headers);
  const auto summary_file =
      arguments.summary.empty() ? nullptr : std::make_unique<record::AtomicFile>(arguments.summary);
  writer->keep(inputs);
  record::Recorder recorder(model, model::constants_of(scenario), grid, columns, *writer);
  std::optional<record::EdgeNote> edge;
  if (record::EdgeNote::wanted(scenario)) edge.emplace(model, scenario.plate, grid, recorder);
  solve::StateSink& sink = edge ? static_cast<solve::StateSink&>(*edge) : recorder;

  Progress progress(scenario.source.file, options.quiet);
  const solve::Watch watch{&watch_signals(),
                           [&](double time) { progress.update(time / grid.end()); }};
  const Integration made = integrate(scenario, model, grid, sink, watch);
  progress.clear();

  std::string reason = shortfall(scenario, model, made);
  const bool finite = recorder.why_not_finite().empty();
  if (reason.empty() && !finite) {
    reason = "the motion was found to its end, but " + recorder.why_not_finite() +
             ".\n  There it is beyond the range of doubles, or not defined.";
  }
  const std::vector<std::string> warnings =
      warnings_of(scenario, model, made.outcome.ending == solve::Ending::failed,
                  edge ? edge->left() : std::nullopt);
  const record::RunSummary summary =
      summarise(scenario, model, made, reason, warnings, output, recorder.peaks());
  if (made.error_estimate) writer->add_column(position_error, made.row_estimates);
  writer->finish(record::to_attributes(summary, scenario.source.text));
  if (summary_file) {
    summary_file->write(record::to_json(summary));
    summary_file->commit();
  }

  if (!reason.empty()) say(reason);
  if (!options.quiet) {
    for (const std::string& warning : warnings) say(warning);
    const std::string noted = noted_text(made.outcome.occurrences);
    if (!noted.empty()) say(noted);
    std::string line = name_of_output(output) + ": " + std::to_string(made.outcome.rows) + " of " +
                       std::to_string(grid.size()) + " rows, " + summary.method + ", " +
                       std::to_string(made.outcome.statistics.steps) + " steps";
    if (made.error_estimate) line += ", error about " + short_number(*made.error_estimate) + " m";
    say(line);
  }
  const ExitCode code = exit_code(made.outcome.ending);
  const bool whole = made.within_error && finite;
  return code == ExitCode::done && !whole ? ExitCode::ended_early : code;
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
  command->callback([arguments, &options, &chosen] {
    chosen = [arguments, &options] { return run(*arguments, options); };
  });
}

}  // namespace bbsim::app
