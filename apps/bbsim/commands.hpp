// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The subcommands and their options. Each add_ function sets the options and the action of one.
// Keeps the parser, CLI11, out of their files: each source that includes its headers constructs
// their validators at every program start, and compiles seconds longer.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/outputs.hpp"
#include "file/table_writer.hpp"
#include "scenario/family.hpp"
#include "scenario/scenario.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI
namespace bbsim::api {
struct Report;
struct RunResult;
}  // namespace bbsim::api
namespace bbsim::results {
struct LogChoice;
}

namespace bbsim::app {

// Action that the command line asks for.
using Chosen = std::function<ExitCode()>;

// Handle of a command's option, cheap to copy.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  // Shows the default in help.
  Option& shows_default();
  // Values separated by commas, in one word: a file may follow.
  Option& parted_by_commas();
  // Takes a decimal number.
  Option& takes_number();
  // Takes a whole number, also as 1e6.
  Option& takes_whole(double least, double most = largest_whole);
  // Takes one value, though it is stored as a list.
  Option& takes_one();
  Option& takes_one_of(const std::vector<std::string>& words);
  Option& excludes(const Option& option);

 private:
  CLI::Option* option_;
};

// Words that takes_one_of() set; empty for other options.
[[nodiscard]] std::vector<std::string> words_of(CLI::Option& option);

// Options of every command.
struct Options {
  bool quiet = false;
};

// Rewords errors about solver.error that --error set as errors about --error.
[[nodiscard]] InputError as_of_error_option(const InputError& error);

class Command {
 public:
  // If the command line names the command, `chosen` becomes its action. Both outlive the command.
  Command(CLI::App& app, Chosen& chosen) : app_(&app), chosen_(&chosen) {}

  [[nodiscard]] std::string name() const;
  // Text below the options in the command's help.
  void footer(const std::string& text);
  // "-o,--output FILE": `names` of an option, and its value in help; or of an argument, without
  // dashes. `value` outlives the parsing. An option with a list may be given several times, each
  // with one value: the scenario may follow. A text must not be empty.
  template <class Value>
  Option option(const std::string& names, Value& value, const std::string& what);
  Option flag(const std::string& names, bool& value, const std::string& what);
  void does(Chosen what);
  // Does `what` with the values of the command's options, which outlive the parsing. If they have
  // an `error`, of --error, faults are reworded as its own.
  template <class Values>
  Values& does(ExitCode (*what)(const Values&, const Options&), const Options& options) {
    const auto values = std::make_shared<Values>();
    does([values, what, &options] {
      try {
        return what(*values, options);
      } catch (const InputError& fault) {
        if constexpr (requires { values->error; }) {
          if (!values->error.empty()) throw as_of_error_option(fault);
        }
        throw;
      }
    });
    return *values;
  }

 private:
  CLI::App* app_;
  Chosen* chosen_;
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

struct NamedCommand {
  const char* group;               // of the list of commands
  const char *name, *description;  // without a description: beside the program
  void (*add_options)(Command& command, const Options& options);
  std::string_view alias{};  // empty: none
};

// Carries out the command line. Throws InputError for a mistake in it, with the word found and the
// command or option nearest to it.
ExitCode run_command(int argc, char** argv, std::span<const NamedCommand> commands);

// Completion: completion.bash asks `bbsim --words WORD...` how the last word may go on.
// One candidate a line; none where a file may stand. `app` has all commands, and the options of
// those among `words`, which begin after the program's name.
[[nodiscard]] std::string candidates(CLI::App& app, std::span<const std::string> words);

// What to use instead of a removed option ("--until"), command ("man") or ending (".glb"); empty if
// no version had it.
[[nodiscard]] std::string instead_of(std::string_view removed);

}  // namespace bbsim::app
