// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A subcommand and its options, for the subcommand's own file. Keeps the parser, CLI11, out of that
// file: each source that includes its headers constructs their validators at every program start,
// and compiles seconds longer.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/number_text.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bbsim::app {

// Action that the command line asks for.
using Chosen = std::function<ExitCode()>;

// Handle of a command's option, cheap to copy.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  // Shows the default in help.
  Option& shows_default();
  // Values separated by commas, in one word: a file may follow.
  Option& parted_by_commas();
  // Takes a decimal number.
  Option& takes_number();
  // Takes a whole number, also as 1e6.
  Option& takes_whole(double least, double most = largest_whole);
  // Takes one value, though it is stored as a list.
  Option& takes_one();
  Option& takes_one_of(const std::vector<std::string>& words);
  Option& excludes(const Option& option);

 private:
  CLI::Option* option_;
};

// Words that takes_one_of() set; empty for other options.
[[nodiscard]] std::vector<std::string> words_of(CLI::Option& option);

class Command {
 public:
  // If the command line names the command, `chosen` becomes its action. Both outlive the command.
  Command(CLI::App& app, Chosen& chosen) : app_(&app), chosen_(&chosen) {}

  [[nodiscard]] std::string name() const;
  // Text below the options in the command's help.
  void footer(const std::string& text);
  // "-o,--output FILE": `names` of an option, and its value in help; or of an argument, without
  // dashes. `value` outlives the parsing. An option with a list may be given several times, each
  // with one value: the scenario may follow. A text must not be empty.
  template <class Value>
  Option option(const std::string& names, Value& value, const std::string& what);
  Option flag(const std::string& names, bool& value, const std::string& what);
  void does(Chosen what);

 private:
  CLI::App* app_;
  Chosen* chosen_;
};

}  // namespace bbsim::app
