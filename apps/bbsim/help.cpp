// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "help.hpp"

#include <cstddef>
#include <string_view>

#include "wrapped.hpp"

// After App.hpp, on which it depends.
#include <CLI/Formatter.hpp>

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

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option),
               make_option_desc(option));
}

// The option's value and its default.
std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0 || option->get_positional()) return "";
  const std::string standard = option->get_default_str();
  return ' ' + option->get_type_name() + (standard.empty() ? "" : '=' + standard);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

// Options of all commands; then the footer, where each line is a paragraph. Lines that start with a
// space stay as they are.
std::string HelpFormatter::make_footer(const CLI::App* command) const {
  std::string text;
  if (const CLI::App* all = command->get_parent()) {
    const CLI::Option* const quiet = all->get_option_no_throw("--quiet");
    if (quiet != nullptr) text = "Options of all commands:\n" + make_option(quiet, false) + '\n';
  }
  std::string footer = command->get_footer();
  // A command without a footer inherits the program's, whose examples do not apply to it.
  if (const CLI::App* all = command->get_parent(); all != nullptr && footer == all->get_footer()) {
    footer = footer.substr(0, footer.find("\n\nExamples:"));
  }
  for (std::string_view rest = footer; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    text += (line.starts_with(' ') ? std::string(line) : wrapped(line, 0, 0, line_width)) + '\n';
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return text;
}

std::string HelpFormatter::make_description(const CLI::App* command) const {
  return wrapped(command->get_description(), 0, 0, line_width) + '\n';
}

}  // namespace bbsim::app
