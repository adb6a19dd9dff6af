// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim run`: simulates a scenario.
#include "api/run.hpp"

#include <optional>
#include <string>
#include <utility>

#include "api/replay.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "commands.hpp"
#include "replay.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct RunArguments {
  ScenarioArguments scenario;
  std::string output, error, replay;
  bool force = false;
  api::RunRequest request;  // filled in from the options
};

// Call it before any of the files is opened.
void declare_files(const RunArguments& arguments, const std::string& output,
                   file::Outputs& outputs) {
  if (!arguments.request.measures.empty()) {
    // Outputs allows a shared pipe, but rows and measures in it could not be told apart.
    for (const auto& [name, option] :
         {std::pair(output, "-o"), {arguments.request.summary, "--summary"}}) {
      if (name != "-") continue;
      throw InputError("--measure: prints to standard output, as " + std::string(option) +
                       " - does; allowed: " + option + " FILE");
    }
    prints(outputs);
  }
  outputs.writes(output, arguments.output.empty() ? "its name by default, without -o" : "-o");
  if (!arguments.request.summary.empty()) outputs.writes(arguments.request.summary, "--summary");
  if (!arguments.replay.empty()) declare_replay(outputs, arguments.replay, "--replay");
}

// "run.csv: 101 of 101 rows, radau, 57 steps"
std::string written_text(const api::RunResult& result) {
  const auto& summary = result.summary;
  const std::string output = name_of_output(summary.output);
  if (summary.rows == 0) return output + ": not written; there are no rows";
  std::string line = output + ": " + std::to_string(summary.rows) + " of " +
                     std::to_string(result.rows_requested) + " rows, " + summary.method + ", " +
                     std::to_string(summary.statistics.steps) + " steps";
  if (!summary.error_estimate) return line;
  return line + ", error about " + short_number(*summary.error_estimate) + " m";
}

ExitCode run(const RunArguments& arguments, const Options& options) {
  if (!arguments.replay.empty()) require_replay_ending(arguments.replay, "--replay");
  const std::string output =
      arguments.output.empty() ? default_output(arguments.scenario.file, ".csv") : arguments.output;
  file::Outputs outputs;
  api::RunRequest request = arguments.request;
  request.scenario =
      read(with_error(arguments.scenario, arguments.error), options, outputs, &request.inputs);
  declare_files(arguments, output, outputs);
  request.output = output;
  request.replaces_its_like_only = arguments.output.empty() && !arguments.force;
  request.pictured = !arguments.replay.empty();
  std::optional<ReplayFile> replay;
  if (request.pictured) request.ready = [&] { replay.emplace(arguments.replay); };

  Progress progress(request.scenario.source.file, options.quiet);
  api::RunResult result = api::run(request, progress);
  if (!arguments.request.measures.empty()) print(measure_text(result.summary.measures));
  say_outcome(result, options.quiet);
  if (!options.quiet) {
    say(written_text(result));
  }
  if (replay && result.summary.rows > 0) {
    replay->write(api::scene_of(std::move(*result.pictured)), options.quiet);
  }
  return result.code;
}

}  // namespace

void add_run(Command& command, const Options& options) {
  command.footer(
      measures_footer() +
      "\n\nExamples:\n"
      "  bbsim run configs/step.yaml --measure x.RiseTime,x.Overshoot,max_tilt\n"
      "  bbsim run configs/rig.yaml --expect \"rms_tracking_error from 5 s < 0.5 mm\" -q\n"
      "  bbsim run configs/fig2a.yaml\n"
      "  bbsim run configs/fig2b.yaml --sensitivity ball.radius,gravity -o by-key.csv\n"
      "  bbsim run configs/fig2a.yaml --set ball.radius=\"2 cm\" -o big.h5\n"
      "  bbsim run configs/fig2b.yaml --error \"1 um\" --summary run.json\n"
      "  bbsim run configs/rig.yaml -o - -q | head -3\n"
      "  bbsim run configs/rig.yaml -o rig.h5 --replay rig.html\n"
      "  sed 's/-10 cm/-5 cm/' configs/fig2a.yaml | bbsim run - -o near.csv");
  RunArguments& arguments = command.does(run, options);
  add_scenario(command, arguments.scenario);
  command.option(
      "-o,--output FILE", arguments.output,
      "write rows to FILE.csv or FILE.h5, or - for CSV on standard output; default: SCENARIO's "
      "name with .csv, in the current folder; if SCENARIO is -, standard output");
  add_force(command, arguments.force);
  add_error(command, arguments.error);
  add_measures(command, arguments.request.measures,
               "print measures of the motion as CSV, measure,value (see below); repeatable");
  command.option("--expect \"MEASURE < VALUE\"", arguments.request.expect,
                 "exit with code 1 if this does not hold, such as \"max_tilt < 5 deg\"; any "
                 "measure, with <, <=, > or >=; repeatable");
  command.option("--sensitivity KEY[,KEY]", arguments.request.sensitivity,
                 "add columns d(x)/d(KEY), the derivatives of the states in output.columns by "
                 "these keys, and gradients of measures to the summary; repeatable");
  command.option("--summary FILE", arguments.request.summary,
                 "write a summary of the run to FILE.json, or - for standard output: how it ended, "
                 "the model, statistics");
  command.option("--replay FILE", arguments.replay, "also write FILE.html, like bbsim replay");
}

}  // namespace bbsim::app
