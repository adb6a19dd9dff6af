// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Options, commands and endings that earlier versions had, with what to use instead
// (docs/how-to/migrate.md).
#include <algorithm>
#include <span>

#include "command_line.hpp"

namespace bbsim::app {
namespace {

struct Removed {
  std::string_view name, instead;
};

constexpr std::string_view runs_whole =
    "runs are no longer split: make the whole run again, which takes milliseconds";

constexpr Removed options[] = {
    {"--save-state", runs_whole},
    {"--from-state", runs_whole},
    {"--continuity", "a fit no longer joins windows; --window sets their length"},
    {"--plot", "`bbsim plot SCENARIO --accuracy` draws what accuracy measures"},
    {"--until", "runs are no longer split; to end a run earlier, use --set time.end=TIME"},
};
constexpr Removed commands[] = {
    {"completion", "bash's completion is installed as share/bash-completion/completions/bbsim"},
    {"man", "man pages are installed where help2man is when bbsim is built; or see --help"},
};
constexpr Removed endings[] = {
    {".glb", "glTF is no longer written; allowed: a page, a name that ends in .html"},
};

std::string text(std::span<const Removed> all, std::string_view name, bool with_name) {
  const auto found = std::ranges::find(all, name, &Removed::name);
  if (found == all.end()) return "";
  const std::string prefix = with_name ? std::string(name) + ": " : "";
  return prefix + std::string(found->instead) + " (docs/how-to/migrate.md)";
}

}  // namespace

std::string removed_option(std::string_view option) {
  return text(options, option, true);
}

std::string removed_command(std::string_view command) {
  return text(commands, command, true);
}

std::string removed_ending(std::string_view ending) {
  return text(endings, ending, false);
}

}  // namespace bbsim::app
