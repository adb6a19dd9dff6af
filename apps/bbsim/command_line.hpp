// What is the same for all commands on a command line: -q, help, and what is said of mistakes.
#pragma once

#include <CLI/App.hpp>

#include "commands.hpp"

namespace bbsim::app {

// -q, before and after all commands that are added later.
void add_quiet(CLI::App& app, Options& options);

// Prints help or the version, where that ended the parsing. Throws InputError for a mistake: what
// was found, and the command or option that is nearest to it.
ExitCode parsing_ended(const CLI::App& app, const CLI::ParseError& error);

void add_help(CLI::App& app, Chosen& chosen);

}  // namespace bbsim::app
