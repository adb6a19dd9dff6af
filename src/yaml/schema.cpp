// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/schema.hpp"

#include <unordered_map>

#include "yaml/spelling.hpp"

namespace bbsim::yaml {

Value Value::item(std::size_t i) const {
  const Node* child = node->items[i];
  return {child, path_of(std::to_string(i)), child->position, context};
}

std::string Value::path_of(std::string_view key) const {
  return path.empty() ? std::string(key) : path + '.' + std::string(key);
}

bool Value::refuse(std::string_view remark, std::string_view allowed) const {
  return report("found " + shown(*node) + std::string(remark) +
                "; allowed: " + std::string(allowed));
}

bool Value::report(std::string_view message) const {
  const std::string text(message);
  context->problems.add(node->position, path.empty() ? text : path + ": " + text);
  return false;
}

bool Value::report_at_key(std::string_view message) const {
  context->problems.add(position, path + ": " + std::string(message));
  return false;
}

std::optional<Value> Value::at(std::string_view below) const {
  Value value = *this;
  while (true) {
    const std::size_t dot = below.find('.');
    const std::string_view name = below.substr(0, dot);
    const std::size_t i = name.size() == 1 ? static_cast<std::size_t>(name[0] - '0') : 10;
    if (i < std::min<std::size_t>(10, value.node->items.size())) {
      value = value.item(i);
    } else if (const Entry* const entry = entry_of(*value.node, name)) {
      value = {entry->value, value.path_of(entry->key), entry->position, context};
    } else {
      return {};
    }
    if (dot == std::string_view::npos) return value;
    below.remove_prefix(dot + 1);
  }
}

std::string_view Value::name() const {
  return std::string_view(path).substr(path.rfind('.') + 1);
}

void Value::note(double number, Dimension dimension) const {
  if (context->numbers != nullptr) (*context->numbers)[american(path)] = {number, dimension};
}

void Value::warn(std::string_view message) const {
  context->problems.remark(node->position, "warning: " + path + ": " + std::string(message));
}

void Value::mention(std::string_view message) const {
  context->problems.remark(node->position, "note: " + path + ": " + std::string(message));
}

void Keys::declare(DeclaredKey key) {
  if (std::ranges::find(declared_->keys, key.name, &DeclaredKey::name) != declared_->keys.end()) {
    return;
  }
  using Words = std::pair<std::string_view, About>;
  const auto words = std::ranges::find(abouts_, key.name, &Words::first);
  if (words != abouts_.end()) key.about = words->second;
  if (key.about.meaning == same.meaning) key.about = declared_->keys.back().about;
  declared_->keys.push_back(std::move(key));
}

const Node& empty_mapping() {
  static const Node empty = [] {
    Node node;
    node.kind = Node::Kind::mapping;
    return node;
  }();
  return empty;
}

void Keys::know(std::string_view key) {
  if (std::ranges::find(known_, key) == known_.end()) known_.push_back(key);
}

const Entry* entry_of(const Node& mapping, std::string_view key) {
  const auto& entries = mapping.entries;
  auto entry = std::ranges::find(entries, key, &Entry::key);
  if (entry == entries.end()) {
    const std::optional<std::string> spelling = other_spelling(key);
    if (spelling) entry = std::ranges::find(entries, *spelling, &Entry::key);
  }
  return entry == entries.end() || entry->value->absent ? nullptr : &*entry;
}

std::optional<Value> Keys::find(std::string_view key) {
  know(key);
  const Entry* const entry = entry_of(*mapping_.node, key);
  if (entry == nullptr) return {};
  return Value{entry->value, mapping_.path_of(entry->key), entry->position, mapping_.context};
}

void Keys::needs(std::string_view key, std::string_view other) {
  if (declared_ != nullptr) declared_->together.emplace_back(key, other);
  const std::optional<Value> value = find(key);
  if (value && !find(other)) {
    value->report("found without " + std::string(other) + "; allowed: only with it");
  }
}

bool Keys::missing(std::string_view key, std::string_view allowed) {
  know(key);
  context().problems.add(mapping_.position,
                         mapping_.path_of(key) + ": missing; allowed: " + std::string(allowed));
  return false;
}

void Keys::one_of(const std::vector<std::string_view>& keys) {
  if (declared_ == nullptr) return;
  Choice& choice = declared_->choices.emplace_back(Choice{{}, true});
  for (const std::string_view key : keys) choice.groups.push_back({key});
}

bool Keys::exactly_one(const std::vector<std::string_view>& keys) {
  one_of(keys);
  std::vector<std::string_view> found;
  for (const std::string_view key : keys) {
    if (find(key)) found.push_back(key);
  }
  if (found.size() == 1) return true;
  const std::string what = found.empty() ? "none" : joined(found);
  context().problems.add(mapping_.position, mapping_.path + ": found " + what +
                                                "; allowed: exactly one of " + joined(keys));
  return false;
}

void Keys::report_unknown(const Entry& entry) const {
  std::vector<std::string> others;
  for (const std::string_view key : known_) {
    if (std::optional<std::string> spelling = other_spelling(key))
      others.push_back(*std::move(spelling));
  }
  std::vector<std::string_view> names = known_;
  names.insert(names.end(), others.begin(), others.end());
  std::string hint = "known keys here: " + joined(known_);
  std::string_view meant = synonym(entry.key, known_);
  if (meant.empty()) meant = nearest_name(entry.key, names);
  const bool from_the_top = meant.find('.') != std::string_view::npos;
  if (!meant.empty()) {
    hint = "did you mean " + (from_the_top ? std::string(meant) : mapping_.path_of(meant)) + "?";
  }
  context().problems.add(entry.position,
                         mapping_.path_of(shown(entry.key)) + ": unknown key; " + hint);
}

void Keys::finish() const {
  std::unordered_map<std::string_view, const Entry*> firsts;  // by known name
  for (const Entry& entry : mapping_.node->entries) {
    auto known = std::ranges::find(known_, entry.key);
    if (known == known_.end()) {
      const std::optional<std::string> spelling = other_spelling(entry.key);
      if (spelling) known = std::ranges::find(known_, *spelling);
    }
    if (known == known_.end()) {
      report_unknown(entry);
      continue;
    }
    const auto [first, is_first] = firsts.emplace(*known, &entry);
    if (!is_first) report_again(entry, *first->second);
  }
}

void Keys::report_again(const Entry& entry, const Entry& first) const {
  const std::string as = entry.key == first.key ? "" : " as " + first.key + ", the same key";
  context().problems.add(
      entry.position, mapping_.path_of(entry.key) + ": found again (first on line " +
                          std::to_string(first.position.line) + as + "); allowed: each key once");
}

}  // namespace bbsim::yaml
