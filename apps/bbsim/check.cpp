// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim check`: what a scenario models, and its loop.
#include "api/check.hpp"

#include "commands.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct Arguments : ScenarioArguments {
  bool verbose = false;
};

ExitCode check(const Arguments& arguments, const Options& options) {
  file::Outputs outputs;
  const Scenario scenario = read(arguments, options, outputs);
  prints(outputs);
  Progress progress(scenario.source.file, options.quiet);
  print_report(api::check(scenario, progress, arguments.verbose));
  return ExitCode::done;
}

}  // namespace

void add_check(Command& command, const Options& options) {
  Arguments& arguments = command.does(check, options);
  add_scenario(command, arguments);
  command.flag("--verbose", arguments.verbose,
               "also say why the solver was chosen, and how stiff the scenario is");
}

}  // namespace bbsim::app
