// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim examples`: lists and writes the scenarios in the program.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "embedded.hpp"
#include "terminal.hpp"
#include "yaml/nearest.hpp"

namespace bbsim::app {
namespace {

constexpr std::string_view ending = ".yaml";

struct ExampleArguments {
  std::string name, output;
  bool force = false;
};

// First sentence of the comment at the start of a scenario.
std::string first_sentence(std::string_view text) {
  std::string sentence;
  while (text.starts_with("# ")) {
    const std::size_t end = text.find('\n');
    sentence += (sentence.empty() ? "" : " ") + std::string(text.substr(2, end - 2));
    text.remove_prefix(end + 1);
  }
  for (std::size_t i = 0; i + 2 < sentence.size(); ++i) {
    const bool ends = sentence[i] == '.' && sentence[i + 1] == ' ';
    if (ends && std::isdigit(static_cast<unsigned char>(sentence[i + 2])) == 0) {  // not "Fig. 2"
      sentence.resize(i + 1);
    }
  }
  if (sentence.ends_with(':')) sentence.back() = '.';
  return sentence;
}

ExitCode list() {
  constexpr std::size_t width = 16;
  std::string report;
  for (const EmbeddedFile& file : example_files()) {
    if (!file.name.ends_with(ending)) continue;
    std::string name(file.name.substr(0, file.name.size() - ending.size()));
    name.resize(std::max(width, name.size()), ' ');
    report += name + ' ' + first_sentence(file.text) + '\n';
  }
  print(report);
  return ExitCode::done;
}

// Finds a scenario, with or without its ending, or a table.
const EmbeddedFile& example(const std::string& name) {
  const auto files = example_files();
  const auto found = std::ranges::find_if(files, [&](const EmbeddedFile& file) {
    return file.name == name || file.name == name + std::string(ending);
  });
  if (found != files.end()) return *found;
  std::vector<std::string_view> known;
  for (const EmbeddedFile& file : files) known.push_back(file.name.substr(0, file.name.find('.')));
  const std::string near(yaml::nearest_name(name, known));
  throw InputError("unknown example " + name +
                   (near.empty() ? "; bbsim examples lists them" : "; did you mean " + near + "?"));
}

ExitCode copy(const ExampleArguments& arguments, const Options& options) {
  const EmbeddedFile& scenario = example(arguments.name);
  const bool named = !arguments.output.empty();
  const std::string output = named ? arguments.output : std::string(scenario.name);
  std::vector<Copy> copies{{output, scenario.text}};
  std::string tables;
  for (const EmbeddedFile& file : example_files()) {
    if (file.name.ends_with(ending) || scenario.text.find(file.name) == std::string_view::npos) {
      continue;
    }
    tables += (tables.empty() ? "" : ", ") + std::string(file.name);
    if (output == "-") continue;
    const auto folder = std::filesystem::path(output).parent_path();
    copies.push_back({(folder / file.name).string(), file.text});
  }
  write_copies(copies, named, arguments.force);
  if (options.quiet) return ExitCode::done;
  if (output != "-") {
    say(output + ": written" + (tables.empty() ? "" : ", with its table " + tables));
  } else if (!tables.empty()) {
    say("it reads " + tables + ": bbsim examples " + tables);
  }
  return ExitCode::done;
}

ExitCode examples(const ExampleArguments& arguments, const Options& options) {
  if (!arguments.name.empty()) return copy(arguments, options);
  if (arguments.output.empty()) return list();
  throw InputError("-o: found without an example's NAME; bbsim examples lists them");
}

}  // namespace

void add_examples(Command& command, const Options& options) {
  const auto arguments = std::make_shared<ExampleArguments>();
  command.option("NAME", arguments->name, "the scenario to write; default: list all");
  command
      .option("-o,--output", arguments->output,
              "write it to FILE.yaml, and its table beside it; default: NAME.yaml in the current "
              "folder; - is standard output")
      .takes("FILE");
  command.flag("--force", arguments->force,
               "replace files that -o does not name, whatever they contain");
  command.does([arguments, &options] { return examples(*arguments, options); });
}

}  // namespace bbsim::app
