// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Commands and options as plain texts, for completion and man pages.
#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace bbsim::app {

struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; or the name of an argument
  std::string takes;               // its value, such as FILE; empty for a flag
  std::string what;
  std::string standard;            // default, as help shows it
  std::vector<std::string> words;  // allowed values, if they are a list
  bool argument = false;           // has no dashes
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

// Call it with a program that has all its commands and options.
[[nodiscard]] ProgramText texts_of(CLI::App& app);

}  // namespace bbsim::app
