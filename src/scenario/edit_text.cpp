// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/edit_text.hpp"

#include <cstddef>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "yaml/document.hpp"
#include "yaml/schema.hpp"

namespace bbsim {
namespace {

using yaml::Entry;
using yaml::Node;
using yaml::Position;

// The length of a scalar that is written on one line without escapes; empty for any other.
std::optional<std::size_t> written_length(std::string_view text, const Node& scalar) {
  if (text.starts_with(scalar.text) && !scalar.quoted) return scalar.text.size();
  if (!text.starts_with('"') && !text.starts_with('\'')) return {};
  const std::size_t end = text.find(text.front(), 1);
  if (end == std::string_view::npos || text.substr(1, end - 1) != scalar.text) return {};
  return end + 1;
}

// Whether the value, whose key or list begins at `from`, is an alias or has an anchor. Its text is
// then also that of another key.
bool is_shared(std::string_view text, const Position& from, const Node& value) {
  if (value.kind == Node::Kind::null) return false;  // without a place in the text
  const std::size_t begin = offset_of(text, from), at = offset_of(text, value.position);
  if (at < begin || from.source != value.position.source) return true;
  if (text.substr(at).starts_with('&')) return true;  // an anchored mapping or list begins there
  const std::string_view before = text.substr(begin, at - begin);
  const std::size_t end = before.find_last_not_of(" \n");
  if (end == std::string_view::npos) return false;
  const std::size_t blank = before.find_last_of(" \n[{,", end);
  return before[blank == std::string_view::npos ? 0 : blank + 1] == '&';
}

// A mapping or a list in the text.
struct Extent {
  std::size_t from, to;
};

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

// The extent of the {...} or [...] at `from`. Ignores brackets in quotes and comments.
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

// The extent of the indented lines below the key at `key`, from the end of the key's line. Empty if
// anything but a comment follows the key on its line, such as an anchor.
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

// Writes "a.b.c" and a value as "a: {b: {c: value}}".
std::string nested(std::string_view path, const std::string& value) {
  const std::size_t dot = path.find('.');
  const std::string name(path.substr(0, dot));
  if (dot == std::string_view::npos) return name + ": " + value;
  return name + ": {" + nested(path.substr(dot + 1), value) + "}";
}

class Editor {
 public:
  Editor(std::string& text, const ScenarioFamily::Setting& setting)
      : text_(text), setting_(setting) {}

  void set(const Node& root) {
    const Node* node = &root;
    const Entry* key = nullptr;  // the entry of `node`
    std::string_view path = setting_.key;
    while (!path.empty()) {
      const std::size_t dot = path.find('.');
      const std::string_view name = path.substr(0, dot);
      const Node* next = nullptr;
      if (node->kind == Node::Kind::mapping) {
        const Entry* const entry = yaml::entry_of(*node, name);
        if (entry == nullptr) return insert(*node, path);
        next = entry->value;
        key = entry;
        if (next != nullptr && is_shared(text_, entry->position, *next)) refuse();
      } else if (node->kind == Node::Kind::sequence) {
        const auto index = number_in<std::size_t>(name);
        if (index && *index < node->items.size()) next = node->items[*index];
        if (next != nullptr && is_shared(text_, node->position, *next)) refuse();
        key = nullptr;
      }
      if (next == nullptr) refuse();
      node = next;
      path.remove_prefix(dot == std::string_view::npos ? path.size() : dot + 1);
    }
    if (node->kind == Node::Kind::scalar) return replace(*node);
    if (key == nullptr || setting_.value == "null") refuse();
    replace_section(*node, *key);
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError("-o: " + setting_.key +
                     ": cannot be set alone in the scenario's text; allowed: a key that is there, "
                     "or whose section is");
  }

  void replace(const Node& scalar) {
    const std::size_t at = offset_of(text_, scalar.position);
    const auto length = written_length(std::string_view(text_).substr(at), scalar);
    if (!length) refuse();
    text_.replace(at, *length, setting_.value);
  }

  // Replaces a mapping or a list. A null node has no place in the text.
  void replace_section(const Node& section, const Entry& key) {
    if (section.kind == Node::Kind::null) refuse();
    const std::size_t name = offset_of(text_, key.position);
    const std::size_t at = offset_of(text_, section.position);
    if (text_[at] == '{' || text_[at] == '[') {
      const auto extent = flow_extent(text_, at);
      if (!extent) refuse();
      text_.replace(at, extent->to - at, setting_.value);
      return;
    }
    const auto extent = block_extent(text_, name);
    if (!extent) refuse();
    text_.erase(extent->from, extent->to - extent->from);
    text_.insert(text_.find(':', name) + 1, ' ' + setting_.value);
  }

  void insert(const Node& mapping, std::string_view path) {
    if (mapping.entries.empty()) refuse();
    const std::string added = nested(path, setting_.value);
    const std::size_t first = offset_of(text_, mapping.entries.front().position);
    const std::size_t before =
        first == 0 ? std::string::npos : text_.find_last_not_of(" \n", first - 1);
    const bool flow = before != std::string::npos && (text_[before] == '{' || text_[before] == ',');
    if (flow) {
      text_.insert(first, added + ", ");
      return;
    }
    // Insert after a neighbor that ends with its line, so that comments stay above their keys.
    const std::string indent(static_cast<std::size_t>(mapping.entries.front().position.column - 1),
                             ' ');
    for (auto entry = mapping.entries.rbegin(); entry != mapping.entries.rend(); ++entry) {
      const Node* const value = entry->value;
      if (value == nullptr || value->kind != Node::Kind::scalar) continue;
      if (value->position.line != entry->position.line) continue;
      const std::size_t at = offset_of(text_, value->position);
      if (!written_length(std::string_view(text_).substr(at), *value)) continue;
      text_.insert(line_end(text_, at), "\n" + indent + added);
      return;
    }
    text_.insert(first, added + "\n" + indent);
  }

  std::string& text_;
  const ScenarioFamily::Setting& setting_;
};

}  // namespace

std::string edited_text(const std::string& text,
                        const std::vector<ScenarioFamily::Setting>& settings) {
  std::string edited(yaml::without_byte_order_mark(text));
  for (const ScenarioFamily::Setting& setting : settings) {
    yaml::Nodes nodes;
    const Node* const root = yaml::parse_yaml(edited, 0, nodes);
    if (root == nullptr) throw InputError("-o: the scenario's text is empty");
    Editor(edited, setting).set(*root);
  }
  return edited;
}

std::string edited_scenario(const Source& source, const std::string& comments,
                            const std::vector<ScenarioFamily::Setting>& settings) {
  std::vector<ScenarioFamily::Setting> all;
  for (const std::string& assignment : source.overrides) {
    const std::size_t equals = assignment.find('=');
    all.push_back({assignment.substr(0, equals), assignment.substr(equals + 1)});
  }
  all.insert(all.end(), settings.begin(), settings.end());
  return comments + edited_text(source.text, all);
}

}  // namespace bbsim
