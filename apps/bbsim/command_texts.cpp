// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command_texts.hpp"

#include <CLI/App.hpp>

namespace bbsim::app {
namespace {

OptionText text_of(CLI::Option& option) {
  OptionText text;
  text.argument = option.get_positional();
  if (text.argument) text.names.push_back(option.get_name());
  for (const std::string& name : option.get_snames()) text.names.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  if (option.get_type_size() != 0) text.takes = option.get_type_name();
  text.what = option.get_description();
  text.standard = option.get_default_str();
  text.words = words_of(option);
  text.required = option.get_required();
  text.repeatable = option.get_items_expected_max() > 1;
  return text;
}

CommandText text_of(CLI::App& command) {
  CommandText text;
  text.name = command.get_name();
  if (!command.get_aliases().empty()) text.alias = command.get_aliases().front();
  text.what = command.get_description();
  text.footer = command.get_footer();
  for (CLI::Option* option : command.get_options({})) text.options.push_back(text_of(*option));
  return text;
}

}  // namespace

ProgramText texts_of(CLI::App& app) {
  ProgramText texts{text_of(app), {}};
  for (CLI::App* command : app.get_subcommands({})) texts.commands.push_back(text_of(*command));
  return texts;
}

}  // namespace bbsim::app
