// The subcommands. Each add_ function declares one; when the command line names it, `chosen` is
// set to what it does.
#pragma once

#include <CLI/App.hpp>
#include <functional>

#include "base/error.hpp"

namespace bbsim::app {

// Options of every command.
struct Options {
  bool quiet = false;
};

using Chosen = std::function<ExitCode()>;

void add_run(CLI::App& app, const Options& options, Chosen& chosen);
void add_check(CLI::App& app, Chosen& chosen);
void add_compare(CLI::App& app, Chosen& chosen);
void add_columns(CLI::App& app, Chosen& chosen);
void add_accuracy(CLI::App& app, const Options& options, Chosen& chosen);

}  // namespace bbsim::app
