// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The command line: its commands, help, messages about mistakes, and completion.
#include <CLI/CLI.hpp>  // at least one source must include all of it
#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "base/text.hpp"
#include "commands.hpp"
#include "embedded.hpp"
#include "scenario/keys.hpp"
#include "terminal.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::app {
namespace {

constexpr std::size_t line_width = 80;
constexpr std::size_t margin = 24;  // where descriptions start

std::string entry(const std::string& name, const std::string& description) {
  std::string text = "  " + name;
  if (description.empty()) return text + '\n';
  text += text.size() + 2 > margin ? '\n' + std::string(margin, ' ')
                                   : std::string(margin - text.size(), ' ');
  return text + wrapped(description, margin, margin, line_width) + '\n';
}

// Layout of --help: no line is wider than 80 columns.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return entry(make_option_name(option, is_positional) + make_option_opts(option),
                 make_option_desc(option));
  }

  // The option's value and its default.
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0 || option->get_positional()) return "";
    const std::string standard = option->get_default_str();
    return ' ' + option->get_type_name() + (standard.empty() ? "" : '=' + standard);
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return entry(command->get_name(), command->get_description());
  }

  std::string make_description(const CLI::App* command) const override {
    return wrapped(command->get_description(), 0, 0, line_width) + '\n';
  }

  // Options of all commands; then the footer, where each line is a paragraph. Lines that start with
  // a space stay as they are.
  std::string make_footer(const CLI::App* command) const override {
    std::string text, footer = command->get_footer();
    if (const CLI::App* all = command->get_parent()) {
      const CLI::Option* const quiet = all->get_option_no_throw("--quiet");
      if (quiet != nullptr) text = "Options of all commands:\n" + make_option(quiet, false) + '\n';
      // A command without a footer inherits the program's, whose examples do not apply to it.
      if (footer == all->get_footer()) footer = footer.substr(0, footer.find("\n\nExamples:"));
    }
    for (const std::string& line : lines_of(footer)) {
      text += (line.starts_with(' ') ? line : wrapped(line, 0, 0, line_width)) + '\n';
    }
    return text;
  }
};

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
    }
  }
  return names;
}

std::string nearest(std::string_view word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return std::string(yaml::nearest_name(word, views));
}

constexpr const char* more = "\nRun bbsim --help for more information.";

std::string known_commands(const CLI::App& app) {
  std::string text = "known:";
  for (const std::string& name : names_of_commands(app)) text += ' ' + name;
  return text;
}

[[noreturn]] void refuse_command(const CLI::App& app, const std::string& word) {
  if (const std::string instead = instead_of(word); !instead.empty()) {
    throw InputError(word + ": " + instead);
  }
  std::vector<std::string> names = names_of_commands(app);
  for (const CLI::App* command : app.get_subcommands({})) {
    for (const std::string& alias : command->get_aliases()) names.push_back(alias);
  }
  const std::string near = nearest(word, names);
  throw InputError("unknown command " + word + "; " +
                   (near.empty() ? known_commands(app) : "did you mean " + near + "?") + more);
}

bool is_option(std::string_view word) {
  return word.size() > 1 && word.front() == '-';
}

// `command` is the given command, or the whole program if none was given.
[[noreturn]] void refuse_word(const CLI::App& app, const CLI::App& command,
                              const std::string& word) {
  const bool whole = &app == &command;
  const std::string name = whole ? "bbsim" : "bbsim " + command.get_name();
  const std::string help = "\nRun " + name + " --help for more information.";
  if (!is_option(word)) {
    throw InputError("found " + word + ", which " + name + " does not take." + help);
  }
  const std::string option = word.substr(0, word.find('='));
  if (!whole && command.get_option_no_throw(option) != nullptr) {
    throw InputError(option + ": found before " + command.get_name() +
                     "; allowed: the options of a command after it." + help);
  }
  if (const std::string instead = instead_of(option); !instead.empty()) {
    throw InputError(option + ": " + instead);
  }
  std::string message = "unknown option " + option + " of " + name;
  const std::size_t letters = option.find_first_not_of('-');
  const std::string near = letters == std::string::npos
                               ? ""
                               : nearest(option.substr(letters), names_of_options(command));
  if (!near.empty()) message += "; did you mean --" + near + "?";
  throw InputError(message + help);
}

// Adds -q, which may stand before and after all commands that are added later.
void add_quiet(CLI::App& app, Options& options) {
  app.fallthrough();  // the commands inherit it, so that the flag may follow them
  app.add_flag("-q,--quiet", options.quiet,
               "print results and the reason why a run ended early; no messages, no progress");
}

// Prints help or the version if that ended the parsing. Throws InputError for a mistake.
ExitCode parsing_ended(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) {
    print(app.help());
    return ExitCode::done;
  }
  if (dynamic_cast<const CLI::CallForVersion*>(&error) != nullptr) {
    print(std::string(error.what()) + '\n');
    return ExitCode::done;
  }
  const std::vector<CLI::App*> given = app.get_subcommands();
  const CLI::App& command = given.empty() ? app : *given.front();
  // Unknown options come first: a misspelled one may be why another is missing.
  const std::vector<std::string> unknown = app.remaining(true);
  for (const std::string& word : unknown) {
    if (is_option(word)) refuse_word(app, command, word);
  }
  if (!unknown.empty() && given.empty()) refuse_command(app, unknown.front());
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !unknown.empty()) {
    refuse_word(app, command, unknown.front());
  }
  if (given.empty()) throw InputError("found no command; " + known_commands(app) + more);
  throw InputError(std::string(error.what()) + "\nRun bbsim " + command.get_name() +
                   " --help for more information.");
}

// Options that print a text and end the program.
void add_texts(CLI::App& app) {
  app.add_flag_callback(
      "--schema", [] { throw CLI::CallForVersion(scenario::json_schema(), 0); },
      "print the JSON Schema of scenarios, and exit");
  app.add_flag_callback(
      "--licenses", [] { throw CLI::CallForVersion(licenses(), 0); },
      "print the licenses of bbsim and of the libraries in it, and exit");
}

void name_program(CLI::App& app, Options& options) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "print this help and exit");
  app.set_version_flag("--version", version,
                       "print the versions of bbsim and its libraries and exit");
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 the run ended early or files differ; 2 the command line or the "
      "scenario is at fault; 3 the output could not be written; 130 interrupted.\n"
      "\n"
      "Run `bbsim COMMAND --help` for the options of a command.\n"
      "\n"
      "Examples:\n"
      "  bbsim new rig --plate \"300 mm x 300 mm\" --ball ping-pong --camera \"30 Hz\"\n"
      "  bbsim check my-rig.yaml\n"
      "  bbsim run my-rig.yaml\n"
      "  bbsim replay my-rig.yaml");
  add_quiet(app, options);
}

constexpr const char* purpose =
    "bbsim simulates a ball rolling on a plate that tilts about two axes (the ball-and-plate rig "
    "of control courses).";

void add_help(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("help", "Print help on bbsim or on one command");
  command->group("Setup");
  const auto name = std::make_shared<std::string>();
  command->add_option("COMMAND", *name, "the command; default: list all commands");
  command->callback([&app, name, &chosen] {
    chosen = [&app, name] {
      if (name->empty()) {
        print(app.get_formatter()->make_help(&app, "bbsim", CLI::AppFormatMode::Normal));
        return ExitCode::done;
      }
      for (const CLI::App* known : app.get_subcommands({})) {
        if (!known->check_name(*name)) continue;
        print(known->help("bbsim"));
        return ExitCode::done;
      }
      refuse_command(app, *name);
    };
  });
}

// Adds the commands, --schema and --licenses. Making all of them takes longer than many a run. If
// the first word names a command, only commands that some word names are made; else all are, for
// help and for messages about mistakes. Only named commands get their options.
void add_commands(CLI::App& app, std::span<char* const> words,
                  std::span<const NamedCommand> commands, const Options& options, Chosen& chosen) {
  const auto calls = [](std::string_view word, const NamedCommand& command) {
    return word == command.name || (!word.empty() && word == command.alias);
  };
  const auto is_named = [&](const NamedCommand& command) {
    return std::ranges::any_of(words, [&](std::string_view word) { return calls(word, command); });
  };
  const auto first = std::ranges::find_if_not(
      words, [](std::string_view word) { return word == "-q" || word == "--quiet"; });
  const bool names_command =
      first != words.end() && std::ranges::any_of(commands, [&](const NamedCommand& command) {
        return calls(*first, command);
      });
  if (!names_command) add_texts(app);
  for (const NamedCommand& command : commands) {
    const bool named = is_named(command);
    if (names_command && !named) continue;
    CLI::App* const added = app.add_subcommand(
        command.name,
        command.description != nullptr ? command.description : description_beside(command.name));
    added->group(command.group);
    if (!command.alias.empty()) added->alias(std::string(command.alias));
    if (!named) continue;
    Command its(*added, chosen);
    command.add_options(its, options);
  }
  if (!names_command || std::ranges::find(words, std::string_view("help")) != words.end()) {
    add_help(app, chosen);
  }
}

}  // namespace

ExitCode run_command(int argc, char** argv, std::span<const NamedCommand> commands) {
  CLI::App app(purpose, "bbsim");
  Options options;
  name_program(app, options);
  Chosen chosen;
  const std::span<char* const> words(argv, static_cast<std::size_t>(argc));
  add_commands(app, words.subspan(std::min<std::size_t>(words.size(), 1)), commands, options,
               chosen);
  if (argc > 1 && words[1] == std::string_view("--words")) {
    print(candidates(app, std::vector<std::string>(words.begin() + 2, words.end())));
    return ExitCode::done;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return parsing_ended(app, error);
  }
  return chosen();
}

std::string instead_of(std::string_view removed) {
  struct Removed {
    std::string_view name, instead;
  };
  constexpr std::string_view runs_whole =
      "runs are no longer split: make the whole run again, which takes milliseconds";
  constexpr Removed all[] = {
      {"--save-state", runs_whole},
      {"--from-state", runs_whole},
      {"--continuity", "a fit no longer joins windows; --window sets their length"},
      {"--plot", "`bbsim plot SCENARIO --accuracy` draws what accuracy measures"},
      {"--until", "runs are no longer split; to end a run earlier, use --set time.end=TIME"},
      {"completion", "bash's completion is installed as share/bash-completion/completions/bbsim"},
      {"man", "man pages are installed where help2man is when bbsim is built; or see --help"},
      {".glb", "glTF is no longer written; allowed: a page, a name that ends in .html"},
  };
  const auto* const found = std::ranges::find(all, removed, &Removed::name);
  return found == std::end(all) ? "" : std::string(found->instead) + " (docs/how-to/migrate.md)";
}

}  // namespace bbsim::app
