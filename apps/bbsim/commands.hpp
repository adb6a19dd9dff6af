// The subcommands. Each add_ function gives one its options; when the command line names it,
// `chosen` is set to what it does.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "file/outputs.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::app {

// Options of every command.
struct Options {
  bool quiet = false;
};

using Chosen = std::function<ExitCode()>;

// The scenario that a command reads, and the keys to set in it: SCENARIO [--set key.path=value]...
struct ScenarioArguments {
  std::string file;
  std::vector<std::string> overrides;
};
void add_scenario(CLI::App& command, ScenarioArguments& arguments);
// --error E: a bound in metres, in place of tolerances; as a further override it comes last.
void add_error(CLI::App& command, std::string& error);
void add_overrides(CLI::App& command, std::vector<std::string>& overrides);

// Where the result goes if nothing else is said: the scenario's name with the suffix, in the
// current folder; what came from standard input goes to standard output.
[[nodiscard]] std::string default_output(const std::string& scenario, const std::string& suffix);

// What an output is called in messages.
[[nodiscard]] std::string name_of_output(const std::string& output);

// Doubles hold whole numbers up to 2^53.
inline constexpr double largest_whole = 9007199254740992.0;

// What an option may be that takes a whole number; 1e6 is one.
[[nodiscard]] CLI::Validator whole_number(double least, double most = largest_whole);

// Says that a command reads a scenario, and these tables with it.
void reads_scenario(file::Outputs& outputs, const std::string& file,
                    const std::vector<std::string>& tables);
// The same of the files that the scene's own controller is made of.
void reads_controller(file::Outputs& outputs, const Scenario& scenario);

// Says that it prints: nothing it reads may be what its standard output goes to.
void prints(file::Outputs& outputs);

// An option that may be given again, each time with one value: what follows may be the scenario.
void may_be_repeated(CLI::Option& option);

void add_run(CLI::App& command, const Options& options, Chosen& chosen);
void add_check(CLI::App& command, Chosen& chosen);
void add_linearize(CLI::App& command, Chosen& chosen);
void add_measure(CLI::App& command, Chosen& chosen);
void add_summarise(CLI::App& command, Chosen& chosen);
void add_compare(CLI::App& command, Chosen& chosen);
void add_verify(CLI::App& command, const Options& options, Chosen& chosen);
void add_columns(CLI::App& command, Chosen& chosen);
void add_accuracy(CLI::App& command, const Options& options, Chosen& chosen);
void add_sweep(CLI::App& command, const Options& options, Chosen& chosen);
void add_merge(CLI::App& command, const Options& options, Chosen& chosen);
void add_plot(CLI::App& command, const Options& options, Chosen& chosen);
void add_replay(CLI::App& command, const Options& options, Chosen& chosen);

}  // namespace bbsim::app
