// The subcommands. Each add_ function declares one; when the command line names it, `chosen` is
// set to what it does.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "record/outputs.hpp"

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

// Says that a command reads a scenario, and these tables with it.
void reads_scenario(record::Outputs& outputs, const std::string& file,
                    const std::vector<std::string>& tables);

// Says that it prints: nothing it reads may be what its standard output goes to.
void prints(record::Outputs& outputs);

// An option that may be given again, each time with one value: what follows may be the scenario.
void may_be_repeated(CLI::Option& option);

void add_run(CLI::App& app, const Options& options, Chosen& chosen);
void add_check(CLI::App& app, Chosen& chosen);
void add_compare(CLI::App& app, Chosen& chosen);
void add_verify(CLI::App& app, const Options& options, Chosen& chosen);
void add_columns(CLI::App& app, Chosen& chosen);
void add_accuracy(CLI::App& app, const Options& options, Chosen& chosen);
void add_sweep(CLI::App& app, const Options& options, Chosen& chosen);
void add_merge(CLI::App& app, const Options& options, Chosen& chosen);

}  // namespace bbsim::app
