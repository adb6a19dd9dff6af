// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/look_up.hpp"

#include <algorithm>

#include "scenario/sections.hpp"
#include "yaml/check_text.hpp"
#include "yaml/spelling.hpp"

namespace bbsim {

using namespace yaml;
using namespace scenario;

namespace {

// The part of a path that exists.
struct Found {
  Position position;           // of the last key that exists
  const Node* node = nullptr;  // its value
  bool whole = false;          // the whole path exists
};

Found find(const Node* root, std::string_view path) {
  Found found{{}, root, false};
  while (found.node != nullptr && !path.empty()) {
    const std::size_t dot = path.find('.');
    const auto& entries = found.node->entries;
    const std::string_view key = path.substr(0, dot);
    auto entry = std::ranges::find(entries, key, &Entry::key);
    if (entry == entries.end()) {
      const std::optional<std::string> spelling = other_spelling(key);
      if (spelling) entry = std::ranges::find(entries, *spelling, &Entry::key);
    }
    if (entry == entries.end()) return found;
    found = {entry->position, entry->value, false};
    path.remove_prefix(dot == std::string_view::npos ? path.size() : dot + 1);
  }
  found.whole = found.node != nullptr;
  return found;
}

Problems problems_of(const Source& source) {
  return {source.file, without_byte_order_mark(source.text), source.overrides};
}

}  // namespace

std::string place_of(const Source& source, std::string_view key) {
  Problems problems = problems_of(source);
  Nodes nodes;
  return problems.where(find(build_tree(source, problems, nodes), key).position);
}

std::optional<double> number_at(const Source& source, std::string_view key, Dimension dimension) {
  Problems unheard = problems_of(source);
  Nodes nodes;
  const Found found = find(build_tree(source, unheard, nodes), key);
  if (!found.whole || found.node->kind != Node::Kind::scalar) return {};
  return read_quantity(found.node->text, found.node->quoted, dimension).value;
}

}  // namespace bbsim
