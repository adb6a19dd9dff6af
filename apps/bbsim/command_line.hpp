// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The command line: which command it names, help, and what is said of mistakes.
#pragma once

#include <span>

#include "commands.hpp"

namespace bbsim::app {

struct NamedCommand {
  const char *name, *description;
  void (*add_options)(Command& command, const Options& options);
  std::string_view alias{};  // empty: none
};

// Does what the command line asks for. Throws InputError for a mistake in it: what was found, and
// the command or option that is nearest to it.
ExitCode obey(int argc, char** argv, std::span<const NamedCommand> commands);

}  // namespace bbsim::app
