// The subcommands. Each add_ function gives one its options, and says what it does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "file/outputs.hpp"
#include "scenario/scenario.hpp"

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

// Where the result goes if nothing else is said: the scenario's name with the suffix, in the
// current folder; what came from standard input goes to standard output.
[[nodiscard]] std::string default_output(const std::string& scenario, const std::string& suffix);

// What an output is called in messages.
[[nodiscard]] std::string name_of_output(const std::string& output);

// Says that a command reads a scenario, and these tables with it.
void reads_scenario(file::Outputs& outputs, const std::string& file,
                    const std::vector<std::string>& tables);
// The same of the tables alone, of a result whose scenario is known.
void reads_tables(file::Outputs& outputs, const std::optional<Scenario>& scenario);
// The same of the files that the scene's own controller is made of.
void reads_controller(file::Outputs& outputs, const Scenario& scenario);

// Says that it prints: nothing it reads may be what its standard output goes to.
void prints(file::Outputs& outputs);

void add_run(Command& command, const Options& options);
void add_check(Command& command, const Options& options);
void add_linearize(Command& command, const Options& options);
void add_measure(Command& command, const Options& options);
void add_summarise(Command& command, const Options& options);
void add_compare(Command& command, const Options& options);
void add_verify(Command& command, const Options& options);
void add_columns(Command& command, const Options& options);
void add_accuracy(Command& command, const Options& options);
void add_sweep(Command& command, const Options& options);
void add_merge(Command& command, const Options& options);
void add_plot(Command& command, const Options& options);
void add_replay(Command& command, const Options& options);

}  // namespace bbsim::app
