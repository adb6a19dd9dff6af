// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/override.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "yaml/problems.hpp"
#include "yaml/spelling.hpp"
#include "yaml/text_file.hpp"

namespace bbsim::yaml {
namespace {

using Path = std::span<const std::string_view>;

std::string path_text(Path names) {
  std::string text;
  for (const std::string_view name : names) {
    if (!text.empty()) text += '.';
    text += name;
  }
  return shown(text);
}

class Setter {
 public:
  // An absent value removes the node at the path.
  Setter(Path path, const Node& value, int source, Nodes& nodes)
      : path_(path), value_(value), source_(source), nodes_(nodes) {}

  // Returns `old` with the value set at the path below `level`. nullptr stands for a missing node.
  [[nodiscard]] const Node* set(const Node* old, std::size_t level) const {
    if (level == path_.size()) return &value_;
    if (old == nullptr || old->kind == Node::Kind::null) {
      if (value_.absent) return old == nullptr ? &value_ : old;  // there is nothing to remove
      Node& created = nodes_.emplace_back();
      created.kind = Node::Kind::mapping;
      created.position = {source_};
      return set_entry(created, level);
    }
    if (old->kind == Node::Kind::mapping) return set_entry(nodes_.emplace_back(*old), level);
    if (old->kind == Node::Kind::sequence) return set_item(nodes_.emplace_back(*old), level);
    fail(path_text(path_.first(level)) + ": found " + shown(*old) +
         ", which has no keys; allowed: a path through mappings and lists");
  }

 private:
  // The key in the mapping's spelling. Parameters of an external controller have only one spelling.
  [[nodiscard]] std::string key_in(const Node& mapping, std::size_t level) const {
    const auto is_there = [&](std::string_view key) {
      return std::ranges::find(mapping.entries, key, &Entry::key) != mapping.entries.end();
    };
    const std::string_view key = path_[level];
    if (is_there(key) || (level > 0 && path_[level - 1] == "parameters")) return std::string(key);
    const std::optional<std::string> spelling = other_spelling(key);
    return spelling && is_there(*spelling) ? *spelling : std::string(key);
  }

  const Node* set_entry(Node& mapping, std::size_t level) const {
    const std::string key = key_in(mapping, level);
    auto entry = std::ranges::find(mapping.entries, key, &Entry::key);
    if (value_.absent && entry != mapping.entries.end() && level + 1 == path_.size()) {
      std::erase_if(mapping.entries, [&](const Entry& existing) { return existing.key == key; });
      return &mapping;
    }
    if (entry == mapping.entries.end()) {
      entry = mapping.entries.insert(entry, {key, {source_}, nullptr});
    } else if (level + 1 == path_.size()) {
      entry->key = path_[level];
      entry->position = {source_};
    }
    entry->value = set(entry->value, level + 1);
    mapping.height = std::max(mapping.height, entry->value->height + 1);
    return &mapping;
  }

  const Node* set_item(Node& list, std::size_t level) const {
    const std::string_view name = path_[level];
    const auto position = number_in<std::size_t>(name);
    const std::size_t index = position.value_or(0);
    // Each position has one spelling; otherwise a sweep would treat .00 and .0 as two keys.
    const bool number = position && (name.size() == 1 || name.front() != '0');
    const std::size_t size = list.items.size();
    if (value_.absent && (!number || index >= size)) {
      fail(path_text(path_.first(level)) + ": found the position " + shown(name) + " in a list" +
           (size == 0 ? ", which has none to remove"
                      : "; allowed: 0 to " + std::to_string(size - 1)));
    }
    if (!number || index > size) {
      fail(path_text(path_.first(level)) + ": found the position " + shown(name) +
           " in a list; allowed: 0 to " + std::to_string(size) + ", where the last appends");
    }
    if (value_.absent && level + 1 == path_.size()) {
      list.items.erase(list.items.begin() + static_cast<std::ptrdiff_t>(index));
      return &list;
    }
    if (index == list.items.size()) list.items.push_back(nullptr);
    list.items[index] = set(list.items[index], level + 1);
    list.height = std::max(list.height, list.items[index]->height + 1);
    return &list;
  }

  [[noreturn]] void fail(const std::string& message) const { throw TextFault({source_}, message); }

  Path path_;
  const Node& value_;
  int source_;
  Nodes& nodes_;
};

// Such a text needs no YAML parser, which would take a third of a sweep's time.
bool is_plain_number(std::string_view text) {
  return text.size() < 40 && text.substr(0, 2) != "--" &&
         text.find_first_not_of("0123456789.eE-+") == std::string_view::npos &&
         text.find_first_of("0123456789") != std::string_view::npos;
}

const Node& parse_value(std::string_view text, int source, Nodes& nodes) {
  if (is_plain_number(text)) {
    Node& number = nodes.emplace_back();
    number.kind = Node::Kind::scalar;
    number.position = {source};
    number.text = text;
    return number;
  }
  if (text.size() > largest_text) {
    throw TextFault({source}, "found " + std::to_string(text.size()) + " bytes; allowed: at most " +
                                  std::to_string(largest_text));
  }
  const Node* value = parse_yaml(check_text(text, source), source, nodes);
  if (value != nullptr && value->kind == Node::Kind::null) {
    Node& absent = nodes.emplace_back(*value);
    absent.absent = true;
    return absent;
  }
  if (value != nullptr) return *value;
  Node& nothing = nodes.emplace_back();
  nothing.position = {source};
  return nothing;
}

}  // namespace

const Node* apply_override(std::string_view assignment, int source, const Node& root,
                           Nodes& nodes) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    throw TextFault({source}, "found no =; allowed: key.path=value, such as ball.radius=0.02");
  }
  return apply_override(assignment.substr(0, equals), assignment.substr(equals + 1), source, root,
                        nodes);
}

const Node* apply_override(std::string_view path, std::string_view value, int source,
                           const Node& root, Nodes& nodes) {
  const std::vector<std::string_view> names = split(path, ".");
  if (std::ranges::find(names, std::string_view()) != names.end()) {
    throw TextFault({source},
                    "found an empty key before the =; allowed: key.path=value, such as "
                    "ball.radius=0.02");
  }
  const Node& node = parse_value(value, source, nodes);
  if (names.size() + static_cast<std::size_t>(node.height) > deepest) {
    throw TextFault({source}, "found nesting deeper than 32 levels; allowed: at most 32");
  }
  return Setter(names, node, source, nodes).set(&root, 0);
}

}  // namespace bbsim::yaml
