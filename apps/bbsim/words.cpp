// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Completion: how the last word of a command line may go on.
#include <CLI/App.hpp>
#include <algorithm>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "scenario/columns.hpp"
#include "scenario/keys.hpp"
#include "scenario/measures.hpp"

namespace bbsim::app {
namespace {

using Names = std::vector<std::string>;

Names columns() {
  const std::vector<std::string_view> names = scenario::column_names();
  return {names.begin(), names.end()};
}

Names measures() {
  Names names = scenario::measures_of(scenario::measured_columns());
  for (const scenario::LoopMeasure& loop : scenario::loop_measures) names.emplace_back(loop.name);
  return names;
}

struct Known {
  std::string_view option;
  Names (*names)();
  const char* end;
};
constexpr Known known[] = {
    {"--set", scenario::key_paths, "="}, {"--vary", scenario::key_paths, "="},
    {"--free", scenario::key_paths, ""}, {"--by", scenario::key_paths, ""},
    {"--over", scenario::key_paths, ""}, {"--sensitivity", scenario::key_paths, ""},
    {"--measure", measures, ""},         {"--expect", measures, ""},
    {"--minimize", measures, ""},        {"--require", measures, ""},
    {"--columns", columns, ""},
};

// Names that go on from the last one of a list, each up to its next dot.
Names dotted(const std::string& text, Names names, const char* end) {
  const std::size_t begin = text.rfind(',') + 1;  // npos + 1 = 0
  const std::string list = text.substr(0, begin), start = text.substr(begin);
  std::ranges::sort(names);
  Names found;
  for (const std::string& name : names) {
    if (!name.starts_with(start)) continue;
    const std::size_t dot = name.find('.', start.size());
    const std::string word =
        list + (dot == std::string::npos ? name + end : name.substr(0, dot + 1));
    if (found.empty() || found.back() != word) found.push_back(word);
  }
  return found;
}

void add_names(const CLI::Option& option, Names& names) {
  for (const std::string& name : option.get_snames()) names.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
}

// The options of a command, or what its arguments may be.
Names names_for(CLI::App& app, CLI::App& command, bool options) {
  Names names;
  for (CLI::Option* option : command.get_options({})) {
    if (options && !option->get_positional()) add_names(*option, names);
    if (options || !option->get_positional()) continue;
    const Names words = words_of(*option);
    names.insert(names.end(), words.begin(), words.end());
  }
  if (options && &command != &app) add_names(*app.get_option("--quiet"), names);
  if (!options && (&command == &app || command.get_name() == "help")) {
    for (const CLI::App* each : app.get_subcommands({})) names.push_back(each->get_name());
  }
  return names;
}

Names found(CLI::App& app, std::span<const std::string> words) {
  std::string text = words.empty() ? "" : words.back();
  CLI::App* command = &app;
  for (const std::string& word : words.first(words.empty() ? 0 : words.size() - 1)) {
    const auto all = app.get_subcommands({});
    const auto named =
        std::ranges::find_if(all, [&](auto* subcommand) { return subcommand->check_name(word); });
    if (named == all.end()) continue;
    command = *named;
    break;
  }
  std::string option = words.size() > 1 ? words[words.size() - 2] : "";
  if (const std::size_t equals = text.find('='); text.starts_with("--") && equals != text.npos) {
    option = text.substr(0, equals);
    text.erase(0, equals + 1);
  }
  Names names;
  CLI::Option* const its = command->get_option_no_throw(option);
  if (option.starts_with('-') && its != nullptr && its->get_type_size() != 0) {
    for (const Known& entry : known) {
      if (its->check_name(std::string(entry.option))) return dotted(text, entry.names(), entry.end);
    }
    names = words_of(*its);
  } else {
    names = names_for(app, *command, text.starts_with('-'));
  }
  std::erase_if(names, [&](const std::string& name) { return !name.starts_with(text); });
  return names;
}

}  // namespace

std::string candidates(CLI::App& app, std::span<const std::string> words) {
  std::string text;
  for (const std::string& name : found(app, words)) text += name + '\n';
  return text;
}

}  // namespace bbsim::app
