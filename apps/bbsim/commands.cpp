// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "api/check.hpp"
#include "api/run.hpp"
#include "results/result.hpp"
#include "scenario/reader.hpp"
#include "terminal.hpp"

namespace bbsim::app {

void add_scenario(Command& command, ScenarioArguments& arguments) {
  command.option("SCENARIO", arguments.file, "a YAML file, or - for standard input").required();
  add_overrides(command, arguments.overrides);
}

void add_overrides(Command& command, std::vector<std::string>& overrides) {
  command.option(
      "--set KEY=VALUE", overrides,
      "set a key of the scenario, such as ball.radius=0.02; null removes it; repeatable");
}

void add_force(Command& command, bool& force) {
  command.flag("--force", force,
               "replace a file with the default name, whatever it contains; only without -o");
}

std::string default_output(const std::string& scenario, const std::string& suffix) {
  if (scenario == "-") return "-";
  return std::filesystem::path(scenario).stem().string() + suffix;
}

std::string name_of_output(const std::string& output) {
  return output == "-" ? "standard output" : output;
}

void add_error(Command& command, std::string& error) {
  command.option("--error E", error,
                 "bound the error of x and y, in meters, at all output times: 1e-9 or \"1 um\"; "
                 "replaces solver.rtol and solver.atol of the scenario");
}

ScenarioArguments with_error(ScenarioArguments arguments, const std::string& error) {
  if (!error.empty()) arguments.overrides.push_back("solver.error=" + error);
  return arguments;
}

InputError as_of_error_option(const InputError& error) {
  constexpr std::string_view as_key = "--set solver.error=", key = "solver.error: ";
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    if (!problem.where.starts_with(as_key)) {
      if (!problem.where.empty() || !problem.message.starts_with(as_key)) continue;
      problem.message = "--error " + problem.message.substr(as_key.size());
      continue;
    }
    problem.where = "--error " + problem.where.substr(as_key.size());
    if (problem.message.starts_with(key)) problem.message.erase(0, key.size());
  }
  return InputError(std::move(problems));
}

Scenario read(const ScenarioArguments& arguments, const Options& options, file::Outputs& outputs,
              std::vector<file::InputTable>* inputs) {
  say_if_waiting(arguments.file, "a scenario", options.quiet);
  Scenario scenario = read_scenario(arguments.file, arguments.overrides, inputs);
  api::reads_scenario(outputs, arguments.file, scenario);
  return scenario;
}

void prints(file::Outputs& outputs) {
  outputs.writes("-", "what is printed");
}

void say_outcome(const api::RunResult& result, bool quiet) {
  if (!result.summary.reason.empty()) say(result.summary.reason);
  for (const std::string& expectation : result.unmet) say(expectation);
  if (quiet) return;
  for (const std::string& warning : result.summary.warnings) say(warning);
  if (!result.noted.empty()) say(result.noted);
}

void print_report(const api::Report& report) {
  constexpr std::size_t fewest = 40;  // narrower terminals break lines themselves
  const std::size_t width = columns_of(STDOUT_FILENO);
  if (width < fewest) return print(to_text(report));
  api::Report broken = report;
  for (api::Line& line : broken) {
    const std::size_t column = std::max(api::label_width, line.label.size()) + 1;
    line.text = wrapped(line.text, api::label_width + 1, column, width);
  }
  print(to_text(broken));
}

void add_log_options(Command& command, results::LogChoice& choice) {
  command.option("--map MAP", choice.maps,
                 "COLUMN=[FACTOR*]NAME[+OFFSET][:UNIT],...: bbsim's COLUMN is FACTOR times the "
                 "log's column NAME plus OFFSET, in UNIT; -NAME changes its sign; default: columns "
                 "match by name, in SI units or in the unit that the name gives; repeatable");
  command
      .option("--header NAME,...", choice.header,
              "the names of the columns of a log without a header")
      .parted_by_commas();
  command.option("--period TIME", choice.period,
                 "the time between rows of a log without a clock: 0.1, \"100 ms\"");
  command.option("--time-offset TIME|start|auto", choice.time_offset,
                 "a time to add to the log's times; or start, so that its first row is t = 0; or, "
                 "in compare and replay, auto, by cross-correlation with the run");
  command.option("--missing VALUE", choice.missing,
                 "leave out rows in which x, y or another position is VALUE: what the log has "
                 "where it does not see the ball, such as -1");
}

}  // namespace bbsim::app
