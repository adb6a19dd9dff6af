// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim check`: what a scenario models, and its loop.
#include "api/check.hpp"

#include <memory>

#include "commands.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

ExitCode check(const ScenarioArguments& arguments, const Options& options) {
  file::Outputs outputs;
  const Scenario scenario = read(arguments, options, outputs);
  prints(outputs);
  Progress progress(scenario.source.file, options.quiet);
  print(to_text(api::check(scenario, progress)));
  return ExitCode::done;
}

}  // namespace

void add_check(Command& command, const Options& options) {
  const auto arguments = std::make_shared<ScenarioArguments>();
  add_scenario(command, *arguments);
  command.does([arguments, &options] { return check(*arguments, options); });
}

}  // namespace bbsim::app
