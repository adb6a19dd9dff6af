// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A subcommand and its options, as its own file names them. What parses the command line stays
// behind command.cpp: each source that sees CLI11's headers makes their validators anew at every
// start of the program, and takes its compiler seconds more.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bbsim::app {

// What the command line asks for.
using Chosen = std::function<ExitCode()>;

// Doubles hold whole numbers up to 2^53.
inline constexpr double largest_whole = 9007199254740992.0;

// An option that a command has; as a handle it is copied.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  // What the option takes, as help shows it.
  Option& takes(const std::string& type);
  Option& required();
  // Help shows what it is without the option.
  Option& shows_default();
  // Values parted by commas, in one word: a file may follow.
  Option& parted_by_commas();
  // It may be given again, each time with one value: what follows may be the scenario.
  Option& may_be_repeated();
  // Takes a whole number; 1e6 is one.
  Option& takes_whole(double least, double most = largest_whole);
  Option& takes_one_of(const std::vector<std::string>& words);
  Option& excludes(const Option& other);

 private:
  CLI::Option* option_;
};

// The words that takes_one_of() named; none for other options.
[[nodiscard]] std::vector<std::string> words_of(CLI::Option& option);

class Command {
 public:
  // When the command line names the command, `chosen` is set to what it does. Both outlive it.
  Command(CLI::App& app, Chosen& chosen) : app_(&app), chosen_(&chosen) {}

  // Below the options in the command's help.
  void footer(const std::string& text);
  // `names` are those of an option, or of an argument without dashes; `value` outlives the parsing.
  Option option(const std::string& names, std::string& value, const std::string& what);
  Option option(const std::string& names, std::size_t& value, const std::string& what);
  Option option(const std::string& names, std::optional<double>& value, const std::string& what);
  Option option(const std::string& names, std::vector<std::string>& values,
                const std::string& what);
  Option option(const std::string& names, std::vector<double>& values, const std::string& what);
  Option flag(const std::string& names, bool& value, const std::string& what);
  void does(Chosen what);

 private:
  CLI::App* app_;
  Chosen* chosen_;
};

}  // namespace bbsim::app
