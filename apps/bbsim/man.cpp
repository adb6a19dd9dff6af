// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "man.hpp"

#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "file/atomic_file.hpp"

namespace bbsim::app {
namespace {

// Text for roff, with everything escaped that roff would interpret.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    const bool begins = result.empty() || result.back() == '\n';
    if (letter == '\\') {
      result += "\\e";
    } else if (letter == '-') {
      result += "\\-";
    } else if (begins && (letter == '.' || letter == '\'')) {
      (result += "\\&") += letter;
    } else {
      result += letter;
    }
  }
  return result;
}

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& letter : result) {
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  }
  return result;
}

std::string bold(std::string_view text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string head(std::string_view name, const std::string& what) {
  return ".TH " + escaped(upper(name)) +
         " 1 \"\" \"bbsim " BBSIM_VERSION "\" \"bbsim\"\n.SH NAME\n" + escaped(name) + " \\- " +
         escaped(what) + '\n';
}

// Names and value of an option; its description; its default.
std::string entry(const OptionText& option) {
  std::string text = ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i) {
    text += i == 0 ? "" : ", ";
    text += option.argument ? italic(option.names[i]) : bold(option.names[i]);
  }
  if (!option.takes.empty() && !option.argument) text += ' ' + italic(option.takes);
  text += '\n' + escaped(option.what);
  if (!option.standard.empty()) text += "; default: " + escaped(option.standard);
  return text + '\n';
}

std::string entries(const char* heading, const std::vector<OptionText>& options, bool arguments) {
  std::string text;
  for (const OptionText& option : options) {
    if (option.argument == arguments) text += entry(option);
  }
  return text.empty() ? text : std::string(".SH ") + heading + '\n' + text;
}

constexpr std::string_view codes = "Exit codes: ";

std::string exit_status(std::string_view line) {
  return ".SH EXIT STATUS\n" + escaped(line.substr(codes.size())) + '\n';
}

// Section about exit codes, from the program's footer.
std::string exit_status(const ProgramText& texts) {
  const std::string& footer = texts.program.footer;
  const std::size_t start = footer.find(codes);
  if (start == std::string::npos) return "";
  return exit_status(std::string_view(footer).substr(start, footer.find('\n', start) - start));
}

// Converts the footer of help. Each line is a paragraph, and lines that start with blanks stay as
// they are. Examples and exit codes get headings.
std::string paragraphs(std::string_view footer) {
  std::string text;
  bool as_it_is = false;
  while (!footer.empty()) {
    const std::size_t end = footer.find('\n');
    const std::string_view line = footer.substr(0, end);
    footer.remove_prefix(end == std::string_view::npos ? footer.size() : end + 1);
    const bool indented = line.starts_with(' ');
    if (indented != as_it_is) text += indented ? ".PP\n.nf\n" : ".fi\n";
    as_it_is = indented;
    if (line.empty()) continue;
    if (indented) {
      text += escaped(line) + '\n';
    } else if (line == "Examples:") {
      text += ".SH EXAMPLES\n";
    } else if (line.starts_with(codes)) {
      text += exit_status(line);
    } else {
      text += ".PP\n" + escaped(line) + '\n';
    }
  }
  return as_it_is ? text + ".fi\n" : text;
}

std::string page_of(const CommandText& command) {
  return "bbsim-" + command.name;
}

// "run", "SCENARIO", "[OPTIONS]", as in the usage line of help.
std::string synopsis(const CommandText& command) {
  std::string text =
      ".SH SYNOPSIS\n" + bold("bbsim " + command.name) + " [" + italic("OPTIONS") + ']';
  for (const OptionText& option : command.options) {
    if (!option.argument) continue;
    const std::string name = italic(option.names.front()) + (option.repeatable ? "..." : "");
    text += ' ' + (option.required ? name : '[' + name + ']');
  }
  return text + '\n';
}

ExitCode write_pages(const std::string& folder, const ProgramText& texts) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  const auto write = [&folder](const std::string& name, const std::string& text) {
    file::AtomicFile file((std::filesystem::path(folder) / (name + ".1")).string());
    file.write(text);
    file.commit();
  };
  write("bbsim", man_page(texts));
  for (const CommandText& command : texts.commands)
    write(page_of(command), man_page(command, texts));
  return ExitCode::done;
}

}  // namespace

std::string man_page(const ProgramText& texts) {
  const std::string& what = texts.program.what;
  std::string text = head("bbsim", "simulate a ball on a plate that tilts about two axes") +
                     ".SH SYNOPSIS\n" + bold("bbsim") + ' ' + italic("COMMAND") + " [" +
                     italic("OPTIONS") + "]\n.SH DESCRIPTION\n" + escaped(what) +
                     "\n.SH COMMANDS\n";
  for (const CommandText& command : texts.commands) {
    text += ".TP\n" + bold(page_of(command)) + "(1)\n" + escaped(command.what);
    if (!command.alias.empty()) text += "; alias: " + escaped(command.alias);
    text += '\n';
  }
  return text + entries("OPTIONS", texts.program.options, false) +
         paragraphs(texts.program.footer) + ".SH SEE ALSO\nman pages of the commands, as " +
         bold("bbsim-run") +
         "(1)\n.PP\n"
         "Tutorials, guides and references: share/doc/bbsim/pages/index.md of the prefix (Debian: "
         "the package bbsim\\-doc).\n";
}

std::string man_page(const CommandText& command, const ProgramText& texts) {
  std::vector<OptionText> options = command.options;
  for (const OptionText& option : texts.program.options) {
    if (option.names.back() == "--quiet") options.push_back(option);
  }
  std::string text = head(page_of(command), command.what) + synopsis(command) +
                     ".SH DESCRIPTION\n" + escaped(command.what) + ".\n" +
                     entries("ARGUMENTS", options, true) + entries("OPTIONS", options, false);
  // A command without a footer inherits the program's.
  if (!command.footer.empty() && command.footer != texts.program.footer) {
    const bool examples_alone = command.footer.starts_with("Examples:");
    text += (examples_alone ? "" : ".SH NOTES\n") + paragraphs(command.footer);
  }
  text += exit_status(texts);
  return text + ".SH SEE ALSO\n" + bold("bbsim") + "(1)\n";
}

void add_man(Command& command, const std::function<ProgramText()>& texts) {
  const auto folder = std::make_shared<std::string>();
  command.option("FOLDER", *folder, "where to write bbsim.1, bbsim-run.1, ...; made if missing")
      .required();
  command.does([folder, texts] { return write_pages(*folder, texts()); });
}

}  // namespace bbsim::app
