// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The commands and options as plain texts, for what is made of them beside --help: completion and
// man pages.
#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace bbsim::app {

struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; of an argument, its name
  std::string takes;               // what it takes, such as FILE; empty for a flag
  std::string what;
  std::string standard;            // shown in help
  std::vector<std::string> words;  // where it takes one of these
  bool argument = false;           // without dashes
  bool required = false;
  bool repeatable = false;
};

struct CommandText {
  std::string name, alias, what, footer;
  std::vector<OptionText> options;
};

struct ProgramText {
  CommandText program;  // with the options that every command takes
  std::vector<CommandText> commands;
};

// Of a program all of whose commands and options are made.
[[nodiscard]] ProgramText texts_of(CLI::App& app);

}  // namespace bbsim::app
