// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "completion.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <set>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/key_paths.hpp"
#include "scenario/measures.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

using Names = std::vector<std::string>;

std::string joined(const Names& words, std::string_view by) {
  std::string text;
  for (const std::string& word : words) (text += text.empty() ? "" : by) += word;
  return text;
}

// Completions of an option or an argument.
struct Offer {
  enum class Kind { nothing, words, keys, key_list, measures, columns, files, folders } kind;
  Names words{};  // the words, or file endings
};
using Kind = Offer::Kind;

// Options whose completion their names decide, whatever help says.
struct Known {
  std::string_view option;
  Kind kind;
};
constexpr Known known[] = {
    {"--set", Kind::keys},         {"--vary", Kind::keys},       {"--free", Kind::keys},
    {"--by", Kind::key_list},      {"--over", Kind::key_list},   {"--sensitivity", Kind::key_list},
    {"--measure", Kind::measures}, {"--expect", Kind::measures}, {"--minimize", Kind::measures},
    {"--require", Kind::measures}, {"--columns", Kind::columns},
};

// File endings that help mentions, as in "FILE.csv or .h5", "CSV" and "a YAML file".
Names endings_in(std::string_view text) {
  std::set<std::string> endings;
  const auto is_part = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0;
  };
  for (std::size_t dot = text.find('.'); dot != std::string_view::npos;
       dot = text.find('.', dot + 1)) {
    std::size_t start = dot, end = dot + 1;
    while (start > 0 && (is_part(text[start - 1]) || text[start - 1] == '-')) --start;
    while (end < text.size() && is_part(text[end])) ++end;
    const std::string_view name = text.substr(start, dot - start);
    const bool stands_for_all = name.empty() || name == "FILE" || name == "LOG";
    if (stands_for_all && end > dot + 1) endings.emplace(text.substr(dot + 1, end - dot - 1));
  }
  const auto says = [text](std::string_view word) {
    return text.find(word) != std::string_view::npos;
  };
  if (endings.empty() && says("CSV")) endings.insert("csv");
  if (says("HDF5 ") || says("HDF5)") || says("HDF5 (")) endings.insert({"csv", "h5"});
  if (endings.contains("h5")) endings.insert("hdf5");
  if (says("YAML file") || says("or scenarios")) endings.insert({"yaml", "yml"});
  return {endings.begin(), endings.end()};
}

Offer offer_of(const OptionText& option) {
  if (!option.words.empty()) return {Kind::words, option.words};
  if (option.takes.empty()) return {Kind::nothing};
  for (const Known& one : known) {
    if (std::ranges::find(option.names, one.option) != option.names.end()) return {one.kind};
  }
  const std::string& type = option.argument ? option.names.front() : option.takes;
  if (type == "FOLDER") return {Kind::folders};
  const Names endings = endings_in(option.takes + ' ' + option.what);
  const bool a_file = option.argument || type.starts_with("FILE") || type == "LOG";
  if (!a_file && (type != "TEXT" || endings.empty())) return {Kind::nothing};
  return {Kind::files, endings};
}

Names sorted(Names words) {
  std::ranges::sort(words);
  return words;
}

Names columns() {
  Names names;
  for (const scenario::Column& column : scenario::catalogue) names.emplace_back(column.name);
  return sorted(names);
}

Names measures() {
  Names names = scenario::measures_of(scenario::measured_columns());
  names.insert(names.end(), {"x_end", "y_end"});
  for (const scenario::LoopMeasure& loop : scenario::loop_measures) names.emplace_back(loop.name);
  return sorted(names);
}

// First clause of a help text.
std::string brief(const std::string& what) {
  return what.substr(0, std::min(what.find("; "), what.find(" (see below)")));
}

// Text within single quotes, for bash and zsh.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char letter : text) result += letter == '\'' ? "'\\''" : std::string(1, letter);
  return result + '\'';
}

// The command's own options, and those of the program that may follow any command.
std::vector<OptionText> options_of(const CommandText& command, const ProgramText& texts) {
  std::vector<OptionText> options;
  for (const OptionText& option : command.options) {
    if (!option.argument) options.push_back(option);
  }
  for (const OptionText& option : texts.program.options) {
    if (option.names.back() == "--quiet") options.push_back(option);
  }
  return options;
}

std::vector<OptionText> arguments_of(const CommandText& command) {
  std::vector<OptionText> arguments;
  for (const OptionText& option : command.options) {
    if (option.argument) arguments.push_back(option);
  }
  return arguments;
}

Names commands_of(const ProgramText& texts) {
  Names names;
  for (const CommandText& command : texts.commands) names.push_back(command.name);
  return names;
}

// The argument of `help COMMAND` completes to the commands.
Offer offer_of(const OptionText& option, const ProgramText& texts) {
  if (option.argument && option.names.front() == "COMMAND") {
    return {Kind::words, commands_of(texts)};
  }
  return offer_of(option);
}

// ---- bash ----

constexpr const char* bash_helpers = R"(
# Adds the words of LIST, each up to its next dot; keeps what is before the last comma of CUR.
_bbsim_dotted() { # CUR END LIST
  local cur=$1 kept= word rest last=
  if [[ $cur == *,* ]]; then
    kept=${cur%,*},
    cur=${cur##*,}
  fi
  for word in $3; do
    [[ $word == "$cur"* ]] || continue
    rest=${word#"$cur"}
    if [[ $rest == *.* ]]; then word=$cur${rest%%.*}.; else word+=$2; fi
    [[ $word == "$last" ]] || COMPREPLY+=("$kept$word")
    last=$word
  done
  compopt -o nospace 2>/dev/null
}

# Adds folders, and files with one of the endings; without endings, all files.
_bbsim_files() { # CUR ENDING...
  local cur=$1 name ending
  shift
  while IFS= read -r name; do COMPREPLY+=("$name"); done < <(
    if (($# == 0)); then
      compgen -f -- "$cur"
    else
      compgen -d -- "$cur"
      for ending; do compgen -f -X "!*.$ending" -- "$cur"; done
    fi
  )
  compopt -o filenames 2>/dev/null
}

_bbsim() {
  local cur=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]} command= options= i
  COMPREPLY=()
  # bash splits words at =, so --set=KEY is three words.
  if [[ $cur == = ]]; then
    [[ $option == --* ]] || return
    cur=
  elif [[ $option == = ]]; then
    option=${COMP_WORDS[COMP_CWORD - 2]}
    [[ $option == --* ]] || return
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then
      command=${COMP_WORDS[i]}
      break
    fi
  done
  case $command in
)";

std::string bash_action(const Offer& offer) {
  switch (offer.kind) {
    case Kind::keys:
      return "_bbsim_dotted \"$cur\" = \"$_bbsim_keys\"";
    case Kind::key_list:
      return "_bbsim_dotted \"$cur\" '' \"$_bbsim_keys\"";
    case Kind::measures:
      return "_bbsim_dotted \"$cur\" '' \"$_bbsim_measures\"";
    case Kind::columns:
      return "_bbsim_dotted \"$cur\" '' \"$_bbsim_columns\"";
    case Kind::words:
      return "COMPREPLY=($(compgen -W '" + joined(offer.words, " ") + "' -- \"$cur\"))";
    case Kind::files:
      return "_bbsim_files \"$cur\" " + joined(offer.words, " ");
    case Kind::folders:
      return "_bbsim_files \"$cur\" /";
    case Kind::nothing:
      break;
  }
  return ":";
}

std::string bash_case(const CommandText& command, const ProgramText& texts) {
  std::string text = "    " + command.name + (command.alias.empty() ? "" : " | " + command.alias);
  text += ")\n      case $option in\n";
  Names all;
  for (const OptionText& option : options_of(command, texts)) {
    all.insert(all.end(), option.names.begin(), option.names.end());
    if (option.takes.empty()) continue;
    text += "        " + joined(option.names, " | ") + ") " + bash_action(offer_of(option, texts)) +
            "; return ;;\n";
  }
  text += "      esac\n      options='" + joined(all, " ") + "'\n";
  const std::vector<OptionText> arguments = arguments_of(command);
  if (!arguments.empty()) {
    text += "      if [[ $cur != -* ]]; then " + bash_action(offer_of(arguments.front(), texts)) +
            "; return; fi\n";
  }
  return text + "      ;;\n";
}

std::string bash_script(const ProgramText& texts) {
  std::string text =
      "# Completion of bbsim for bash, made by `bbsim completion bash`.\n"
      "_bbsim_keys='" +
      joined(scenario::key_paths(), " ") + "'\n_bbsim_measures='" + joined(measures(), " ") +
      "'\n_bbsim_columns='" + joined(columns(), " ") + "'\n" + bash_helpers;
  for (const CommandText& command : texts.commands) text += bash_case(command, texts);
  Names words = commands_of(texts);
  for (const OptionText& option : texts.program.options) {
    words.insert(words.end(), option.names.begin(), option.names.end());
  }
  return text + "    '') options='" + joined(words, " ") +
         "' ;;\n"
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))\n"
         "}\n"
         "complete -F _bbsim bbsim\n";
}

// ---- zsh ----

constexpr const char* zsh_helpers = R"(
# Offers the words, each up to its next dot; keeps what is before the last comma.
_bbsim_dotted() { # END WORD...
  local end=$1 word rest
  local -aU found
  shift
  compset -P '*,'
  for word; do
    [[ $word == $PREFIX* ]] || continue
    rest=${word#$PREFIX}
    if [[ $rest == *.* ]]; then found+=("$PREFIX${rest%%.*}."); else found+=("$word$end"); fi
  done
  compadd -S '' -- $found
}
_bbsim_key() { _bbsim_dotted = $_bbsim_keys }
_bbsim_key_list() { _bbsim_dotted '' $_bbsim_keys }
_bbsim_measure_list() { _bbsim_dotted '' $_bbsim_measures }
_bbsim_column_list() { _bbsim_dotted '' $_bbsim_columns }

)";

std::string zsh_action(const Offer& offer) {
  switch (offer.kind) {
    case Kind::keys:
      return "_bbsim_key";
    case Kind::key_list:
      return "_bbsim_key_list";
    case Kind::measures:
      return "_bbsim_measure_list";
    case Kind::columns:
      return "_bbsim_column_list";
    case Kind::words:
      return '(' + joined(offer.words, " ") + ')';
    case Kind::files:
      if (offer.words.empty()) return "_files";
      return "_files -g \"*.(" + joined(offer.words, "|") + ")\"";
    case Kind::folders:
      return "_files -/";
    case Kind::nothing:
      break;
  }
  return " ";
}

std::string zsh_escaped(const std::string& text, std::string_view special) {
  std::string result;
  for (const char letter : text) {
    if (special.find(letter) != std::string_view::npos) result += '\\';
    result += letter;
  }
  return result;
}

// One entry for each name: '(-o --output)--output=[write rows]:FILE:_files'.
std::string zsh_option(const OptionText& option, const ProgramText& texts) {
  std::string text;
  for (const std::string& name : option.names) {
    std::string spec = option.repeatable ? "*" : '(' + joined(option.names, " ") + ')';
    spec += name;
    if (!option.takes.empty() && name.starts_with("--")) spec += '=';
    spec += '[' + zsh_escaped(brief(option.what), "\\[]") + ']';
    if (!option.takes.empty()) {
      spec += ':' + zsh_escaped(option.takes, "\\:") + ':' + zsh_action(offer_of(option, texts));
    }
    text += " \\\n        " + quoted(spec);
  }
  return text;
}

std::string zsh_case(const CommandText& command, const ProgramText& texts) {
  std::string text = "      " + command.name + (command.alias.empty() ? "" : '|' + command.alias) +
                     ")\n        _arguments -s";
  for (const OptionText& option : options_of(command, texts)) text += zsh_option(option, texts);
  int position = 0;
  for (const OptionText& argument : arguments_of(command)) {
    std::string spec = argument.repeatable ? "*" : std::to_string(++position);
    spec += argument.required || argument.repeatable ? ":" : "::";
    spec += argument.names.front() + ':' + zsh_action(offer_of(argument, texts));
    text += " \\\n        " + quoted(spec);
  }
  return text + " ;;\n";
}

std::string zsh_script(const ProgramText& texts) {
  std::string text =
      "#compdef bbsim\n"
      "# Completion of bbsim for zsh, made by `bbsim completion zsh`.\n"
      "typeset -ga _bbsim_keys=(" +
      joined(scenario::key_paths(), " ") + ")\ntypeset -ga _bbsim_measures=(" +
      joined(measures(), " ") + ")\ntypeset -ga _bbsim_columns=(" + joined(columns(), " ") + ")\n" +
      zsh_helpers +
      "_bbsim() {\n"
      "  local curcontext=$curcontext state\n"
      "  local -A opt_args\n"
      "  _arguments -C";
  for (const OptionText& option : texts.program.options) text += zsh_option(option, texts);
  text +=
      " \\\n        '1:command:->command' '*::argument:->arguments'\n"
      "  case $state in\n"
      "  command)\n"
      "    local -a commands=(\n";
  for (const CommandText& command : texts.commands) {
    text += "      " + quoted(command.name + ':' + command.what) + '\n';
  }
  text +=
      "    )\n"
      "    _describe command commands ;;\n"
      "  arguments)\n"
      "    case $words[1] in\n";
  for (const CommandText& command : texts.commands) text += zsh_case(command, texts);
  return text +
         "    esac ;;\n"
         "  esac\n"
         "}\n\n"
         "if [[ $funcstack[1] == _bbsim ]]; then _bbsim \"$@\"; else compdef _bbsim bbsim; fi\n";
}

// ---- fish ----

constexpr const char* fish_helpers = R"(
# The current word, without --option= before it.
function __bbsim_word
    commandline -ct | string replace -r '^--[a-z-]+=' ''
end

# Words, each up to its next dot; keeps what is before the last comma.
function __bbsim_dotted # END WORD...
    set -l word (__bbsim_word)
    set -l kept (string match -r '^.*,' -- $word; or echo '')
    set -l cur (string replace -r '^.*,' '' -- $word)
    set -l pattern '^('(string escape --style=regex -- "$cur")'[^.]*\.).*$'
    for found in (string match -- "$cur*" $argv[2..] | string replace -r -- $pattern '$1')
        string match -q -- '*.' $found; and echo $kept$found; or echo $kept$found$argv[1]
    end
end

# Folders, and files with one of the endings; without endings, all files.
function __bbsim_files
    if test (count $argv) -eq 0
        __fish_complete_path (__bbsim_word)
    else
        __fish_complete_path (__bbsim_word) |
            string match -r -- '^[^\t]*(?:/|\.(?:'(string join '|' $argv)'))(?:\t.*)?$'
    end
end

complete -c bbsim -f
)";

std::string fish_quoted(const std::string& text) {
  return '\'' + zsh_escaped(text, "\\'") + '\'';
}

std::string fish_action(const Offer& offer) {
  switch (offer.kind) {
    case Kind::keys:
      return "(__bbsim_dotted = $__bbsim_keys)";
    case Kind::key_list:
      return "(__bbsim_dotted \"\" $__bbsim_keys)";
    case Kind::measures:
      return "(__bbsim_dotted \"\" $__bbsim_measures)";
    case Kind::columns:
      return "(__bbsim_dotted \"\" $__bbsim_columns)";
    case Kind::words:
      return joined(offer.words, " ");
    case Kind::files:
      return "(__bbsim_files " + joined(offer.words, " ") + ')';
    case Kind::folders:
      return "(__fish_complete_directories (__bbsim_word))";
    case Kind::nothing:
      break;
  }
  return "";
}

std::string fish_option(const OptionText& option, const std::string& condition,
                        const ProgramText& texts) {
  std::string text = "complete -c bbsim -n " + condition;
  for (const std::string& name : option.names) {
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.takes.empty()) text += " -x";
  const std::string action = fish_action(offer_of(option, texts));
  if (!action.empty()) text += " -a " + fish_quoted(action);
  return text + " -d " + fish_quoted(brief(option.what)) + '\n';
}

std::string fish_script(const ProgramText& texts) {
  std::string text =
      "# Completion of bbsim for fish, made by `bbsim completion fish`.\n"
      "set -g __bbsim_keys " +
      joined(scenario::key_paths(), " ") + "\nset -g __bbsim_measures " + joined(measures(), " ") +
      "\nset -g __bbsim_columns " + joined(columns(), " ") + '\n' + fish_helpers;
  for (const OptionText& option : texts.program.options) {
    text += fish_option(option, "__fish_use_subcommand", texts);
  }
  for (const CommandText& command : texts.commands) {
    text += "complete -c bbsim -n __fish_use_subcommand -a " + command.name + " -d " +
            fish_quoted(command.what) + '\n';
    const std::string condition = fish_quoted("__fish_seen_subcommand_from " + command.name +
                                              (command.alias.empty() ? "" : ' ' + command.alias));
    for (const OptionText& option : options_of(command, texts)) {
      text += fish_option(option, condition, texts);
    }
    const std::vector<OptionText> arguments = arguments_of(command);
    if (arguments.empty()) continue;
    text += "complete -c bbsim -n " + condition + " -a " +
            fish_quoted(fish_action(offer_of(arguments.front(), texts))) + '\n';
  }
  return text;
}

}  // namespace

std::string completion_script(std::string_view shell, const ProgramText& texts) {
  return shell == "bash"  ? bash_script(texts)
         : shell == "zsh" ? zsh_script(texts)
                          : fish_script(texts);
}

void add_completion(Command& command, const std::function<ProgramText()>& texts) {
  command.footer(
      "A package installs the scripts where the shells look for them. Otherwise:\n"
      "  bash  source <(bbsim completion bash)       in ~/.bashrc\n"
      "  zsh   source <(bbsim completion zsh)        in ~/.zshrc, after compinit\n"
      "  fish  bbsim completion fish | source        in ~/.config/fish/config.fish");
  const auto shell = std::make_shared<std::string>();
  command.option("SHELL", *shell, "bash, zsh or fish")
      .required()
      .takes_one_of({"bash", "zsh", "fish"});
  command.does([shell, texts] {
    print(completion_script(*shell, texts()));
    return ExitCode::done;
  });
}

}  // namespace bbsim::app
