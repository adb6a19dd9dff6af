// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The command line: its commands, help, and messages about mistakes.
#pragma once

#include <span>

#include "commands.hpp"

namespace bbsim::app {

struct NamedCommand {
  const char* group;               // of the list of commands
  const char *name, *description;  // without a description: beside the program
  void (*add_options)(Command& command, const Options& options);
  std::string_view alias{};  // empty: none
};

// Carries out the command line. Throws InputError for a mistake in it, with the word found and the
// command or option nearest to it.
ExitCode run_command(int argc, char** argv, std::span<const NamedCommand> commands);

}  // namespace bbsim::app
