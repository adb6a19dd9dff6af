// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The subcommands. Each add_ function gives one its options, and says what it does.
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
struct RunResult;
}
namespace bbsim::plot {
struct LogChoice;
}

namespace bbsim::app {

// Options of every command.
struct Options {
  bool quiet = false;
};

// The scenario that a command reads, and the keys to set in it: SCENARIO [--set key.path=value]...
struct ScenarioArguments {
  std::string file;
  std::vector<std::string> overrides;
};
void add_scenario(Command& command, ScenarioArguments& arguments);
// --error E: a bound in metres, in place of tolerances; as a further override it comes last.
void add_error(Command& command, std::string& error);
[[nodiscard]] ScenarioArguments with_error(ScenarioArguments arguments, const std::string& error);
// --force: see file::require_like().
void add_force(Command& command, bool& force);
// What is wrong with solver.error as --error gave it, in --error's words.
[[nodiscard]] InputError as_of_error_option(const InputError& error);
// What `what` returns; its InputErrors as_of_error_option, if --error was given.
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

// --map, --header, --period and --time-offset of a log.
void add_log_options(Command& command, results::LogChoice& choice);

// Where the result goes if nothing else is said: the scenario's name with the suffix, in the
// current folder; what came from standard input goes to standard output.
[[nodiscard]] std::string default_output(const std::string& scenario, const std::string& suffix);

// --measure NAME,...; may be given again. What a measure's name may be, for a command's help. And
// what was measured as CSV: measure,value.
Option add_measures(Command& command, std::vector<std::string>& lists, const std::string& what);
[[nodiscard]] std::string measures_footer();
[[nodiscard]] std::string measure_text(const std::vector<std::pair<std::string, double>>& measures);

// What an output is called in messages.
[[nodiscard]] std::string name_of_output(const std::string& output);

// Reads a scenario, and says that the command does, with its tables and its own controller.
// `inputs`, if it is given, gets its tables.
[[nodiscard]] Scenario read(const ScenarioArguments& arguments, const Options& options,
                            file::Outputs& outputs,
                            std::vector<file::InputTable>* inputs = nullptr);

// Whether a file among results is a scenario, by its ending.
[[nodiscard]] bool is_scenario(const std::string& file);

void add_threads(Command& command, std::size_t& threads);

// What a command writes that finds values of keys: the scenario with the values in it, and JSON.
struct FoundFiles {
  std::string scenario, json, page{};  // - is standard output; empty: not written

  // A report goes to standard output where no file does.
  [[nodiscard]] bool reports() const { return scenario != "-" && json != "-" && page != "-"; }
  void declare(file::Outputs& outputs) const;
  // Says so if the scenario goes to another folder than the one it is made of: its tables are named
  // from there.
  void write(const ScenarioFamily& family, const std::string& scenario_text,
             const std::string& json_text, const std::string& report, bool quiet) const;
};
// Options -o and --json. `values`: what the scenario has in it, as in "the estimates".
void add_found_files(Command& command, FoundFiles& files, const std::string& values);

// Says that it prints: nothing it reads may be what its standard output goes to.
void prints(file::Outputs& outputs);

// Says why a run ended early and what is not as expected, and, unless it is to be quiet, warnings
// and what was noted.
void tell(const api::RunResult& made, bool quiet);

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
void add_fit(Command& command, const Options& options);
void add_design(Command& command, const Options& options);
void add_tune(Command& command, const Options& options);
void add_sketch(Command& command, const Options& options);
void add_plot(Command& command, const Options& options);
void add_replay(Command& command, const Options& options);

}  // namespace bbsim::app
