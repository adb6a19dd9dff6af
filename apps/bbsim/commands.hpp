// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The subcommands. Each add_ function sets the options and the action of one.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "file/outputs.hpp"
#include "file/table_writer.hpp"
#include "scenario/family.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {
struct Line;
using Report = std::vector<Line>;
struct RunResult;
}  // namespace bbsim::api
namespace bbsim::results {
struct LogChoice;
}

namespace bbsim::app {

// Options of every command.
struct Options {
  bool quiet = false;
};

// Scenario that a command reads, and keys to set in it: SCENARIO [--set key.path=value]...
struct ScenarioArguments {
  std::string file;
  std::vector<std::string> overrides;
};
void add_scenario(Command& command, ScenarioArguments& arguments);
// --error E: error bound in meters, in place of tolerances; appended as the last override.
void add_error(Command& command, std::string& error);
[[nodiscard]] ScenarioArguments with_error(ScenarioArguments arguments, const std::string& error);
// --force: see file::require_like().
void add_force(Command& command, bool& force);
// Rewords errors about solver.error that --error set as errors about --error.
[[nodiscard]] InputError as_of_error_option(const InputError& error);
// Calls `what`. If --error was given, its InputErrors become as_of_error_option().
template <class What>
ExitCode with_error_option(const std::string& error, const What& what) {
  if (error.empty()) return what();
  try {
    return what();
  } catch (const InputError& fault) {
    throw as_of_error_option(fault);
  }
}
void add_overrides(Command& command, std::vector<std::string>& overrides);

// --map, --header, --period, --time-offset and --missing of a log.
void add_log_options(Command& command, results::LogChoice& choice);

// Default output: the scenario's name with the suffix, in the current folder. For a scenario from
// standard input, standard output.
[[nodiscard]] std::string default_output(const std::string& scenario, const std::string& suffix);

// --measure NAME,..., which may be repeated; help text on measure names; and measured values as
// CSV: measure,value.
Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what);
[[nodiscard]] std::string measures_footer();
[[nodiscard]] std::string measure_text(const std::vector<std::pair<std::string, double>>& measures);

// Name of an output in messages.
[[nodiscard]] std::string name_of_output(const std::string& output);

// Reads a scenario, and declares it, its tables and its controller as inputs of the command.
// `inputs`, if given, receives the tables.
[[nodiscard]] Scenario read(const ScenarioArguments& arguments, const Options& options,
                            file::Outputs& outputs,
                            std::vector<file::InputTable>* inputs = nullptr);

void add_threads(Command& command, std::size_t& threads);

// Declares standard output as an output, so that it cannot overwrite an input.
void prints(file::Outputs& outputs);

// Prints why a run ended early and which expectations fail; unless `quiet`, also warnings and noted
// events.
void say_outcome(const api::RunResult& result, bool quiet);

// Prints a report, on a terminal with lines that break between words.
void print_report(const api::Report& report);

void add_run(Command& command, const Options& options);
void add_check(Command& command, const Options& options);
void add_linearize(Command& command, const Options& options);
void add_measure(Command& command, const Options& options);
void add_summarize(Command& command, const Options& options);
void add_compare(Command& command, const Options& options);
void add_verify(Command& command, const Options& options);
void add_columns(Command& command, const Options& options);
void add_accuracy(Command& command, const Options& options);
void add_sweep(Command& command, const Options& options);
void add_merge(Command& command, const Options& options);
void add_new(Command& command, const Options& options);
void add_examples(Command& command, const Options& options);
void add_sketch(Command& command, const Options& options);
void add_replay(Command& command, const Options& options);

// Any command that lives beside the program, and its description.
void add_beside(Command& command, const Options& options);
[[nodiscard]] std::string description_beside(const std::string& command);

}  // namespace bbsim::app
