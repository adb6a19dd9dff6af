// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The command line: its commands, help, messages about mistakes, and completion.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "commands.hpp"

namespace CLI {
class App;
}

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

// Completion: completion.bash asks `bbsim --words WORD...` how the last word may go on.
// One candidate a line; none where a file may stand. `app` has all commands, and the options of
// those among `words`, which begin after the program's name.
[[nodiscard]] std::string candidates(CLI::App& app, std::span<const std::string> words);

// A sentence about the removed option ("--until"), command ("man") or ending (".glb"); empty if no
// version had it.
[[nodiscard]] std::string removed_option(std::string_view option);
[[nodiscard]] std::string removed_command(std::string_view command);
[[nodiscard]] std::string removed_ending(std::string_view ending);

}  // namespace bbsim::app
