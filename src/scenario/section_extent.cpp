// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/section_extent.hpp"

#include <algorithm>

namespace bbsim::scenario {
namespace {

constexpr std::size_t none = std::string_view::npos;

std::size_t line_end(std::string_view text, std::size_t at) {
  return std::min(text.find('\n', at), text.size());
}

// The last character of the quoted text at `at`. Two single quotes in it are one letter.
std::size_t quote_end(std::string_view text, std::size_t at) {
  const char quote = text[at];
  for (++at; at < text.size(); ++at) {
    const bool doubled = quote == '\'' && text.substr(at).starts_with("''");
    if (doubled || (quote == '"' && text[at] == '\\')) {
      ++at;
    } else if (text[at] == quote) {
      break;
    }
  }
  return at;
}

}  // namespace

std::optional<Extent> flow_extent(std::string_view text, std::size_t from) {
  constexpr std::string_view blanks = " \t\r\n", before_value = "{[,:";
  int depth = 0;
  char last = '{';  // the last character that is no blank
  for (std::size_t at = from; at < text.size(); ++at) {
    const char c = text[at];
    const bool after_space = at == 0 || text[at - 1] == ' ' || text[at - 1] == '\n';
    if (c == '#' && after_space) {
      at = line_end(text, at);
      continue;
    }
    if ((c == '"' || c == '\'') && before_value.find(last) != none) {
      at = quote_end(text, at);  // elsewhere, as in it's, a quote is a letter
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if (c == '}' || c == ']') {
      if (--depth == 0) return Extent{from, at + 1};
    }
    if (blanks.find(c) == none) last = c;
  }
  return {};
}

std::optional<Extent> block_extent(std::string_view text, std::size_t key) {
  const std::size_t newline = text.rfind('\n', key);
  const std::size_t column = key - (newline == none ? 0 : newline + 1);
  const std::size_t first = line_end(text, key);
  const std::size_t colon = text.substr(0, first).find(':', key);
  if (colon == none) return {};
  const std::size_t more = text.find_first_not_of(" \r", colon + 1);
  if (more < first && text[more] != '#') return {};
  Extent found{first, first};
  for (std::size_t end = first; end < text.size();) {
    const std::size_t start = end + 1;
    end = line_end(text, start);
    const std::size_t word = text.find_first_not_of(" \r", start);
    // Blank lines and comments belong to the key below them.
    if (word == none || word >= end || text[word] == '#') continue;
    const std::size_t indent = word - start;
    const bool item = indent == column && text[word] == '-';
    if (indent <= column && !item) break;
    found.to = end;
  }
  return found.to > found.from ? std::optional(found) : std::nullopt;
}

}  // namespace bbsim::scenario
