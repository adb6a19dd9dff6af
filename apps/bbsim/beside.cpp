// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Commands that live beside the program: `bbsim plot` becomes libexec/bbsim/bbsim-plot, in Python.
// Their options are in python/bbsim/commands.json, so that help and mistakes need no Python.
#include <unistd.h>

#include <filesystem>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json.hpp"
#include "base/number_text.hpp"
#include "commands.hpp"
#include "embedded.hpp"
#include "file/share_folders.hpp"

namespace bbsim::app {
namespace {

Json table_of(const std::string& command) {
  return parse_json(text_of(command_tables(), "commands.json")).at(command);
}

// An option and what was given for it.
struct Given {
  std::string name;  // --output; empty for files
  bool is_set = false;
  std::vector<std::string> values{};
};

// The command line in one spelling. A file that begins with a dash gets its folder.
std::vector<std::string> words_of(const std::list<Given>& all, bool quiet) {
  std::vector<std::string> words, files;
  if (quiet) words.emplace_back("-q");
  for (const Given& option : all) {
    if (option.is_set) words.push_back(option.name);
    for (const std::string& value : option.values) {
      const bool looks_like_option = value.size() > 1 && value.front() == '-';
      if (!option.name.empty()) words.push_back(option.name + '=' + value);
      if (option.name.empty()) files.push_back((looks_like_option ? "./" : "") + value);
    }
  }
  words.insert(words.end(), files.begin(), files.end());
  return words;
}

ExitCode execute(const std::string& command, std::vector<std::string> words) {
  const std::string name = "bbsim-" + command;
  words.insert(words.begin(), name);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::vector<std::string> folders = file::libexec_folders();
  for (const std::string& folder : folders) {
    execv((std::filesystem::path(folder) / name).c_str(), arguments.data());
  }
  throw InputError("bbsim " + command + " needs bbsim's Python package, which is not in " +
                   folders.front() +
                   "; install it (Debian: python3-bbsim) and apt install python3-numpy "
                   "python3-scipy python3-matplotlib" +
                   (command == "plot" ? "; bbsim replay draws without it" : ""));
}

}  // namespace

std::string description_beside(const std::string& command) {
  return table_of(command).at("description");
}

void add_beside(Command& command, const Options& options) {
  const Json table = table_of(command.name());
  command.footer(table.at("footer"));
  const auto all = std::make_shared<std::list<Given>>();
  for (const Json& option : table.at("options")) {
    const std::string names = option.at("names"), help = option.at("help");
    const std::size_t dashes = names.rfind("--");
    Given& given = all->emplace_back();
    if (dashes != std::string::npos) given.name = names.substr(dashes);
    if (option.value("flag", false)) {
      command.flag(names, given.is_set, help);
      continue;
    }
    const std::string takes = option.value("takes", "");
    Option added = command.option(names + (takes.empty() ? "" : " " + takes), given.values, help);
    if (option.value("required", false)) added.required();
    if (option.contains("whole")) added.takes_whole(option.at("whole"), largest_whole);
    if (option.contains("choices")) added.takes_one_of(option.at("choices"));
    if (!option.value("repeatable", false)) added.takes_one();
  }
  command.does([name = command.name(), all, &options] {
    return execute(name, words_of(*all, options.quiet));
  });
}

}  // namespace bbsim::app
