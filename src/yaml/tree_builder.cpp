// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/tree_builder.hpp"

#include <algorithm>
#include <utility>

namespace bbsim::yaml {
namespace {

// More than any scenario needs, in little memory.
constexpr std::size_t most_nodes = 100'000;

}  // namespace

Position TreeBuilder::at(const YAML::Mark& mark) const {
  return {source_, std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

bool TreeBuilder::expects_key() const {
  return !open_.empty() && open_.back().node->kind == Node::Kind::mapping && !open_.back().key;
}

Node& TreeBuilder::add(Node::Kind kind, const YAML::Mark& mark) {
  if (nodes_.size() >= most_nodes) {
    throw TextFault(at(mark), "found more than 100000 values; allowed: at most that many");
  }
  Node& node = nodes_.emplace_back();
  node.kind = kind;
  node.position = at(mark);
  return node;
}

// yaml-cpp gives plain nodes without a tag the tag "?" or none, and quoted nodes "!".
void TreeBuilder::refuse_tag(const std::string& tag, const YAML::Mark& mark) const {
  if (tag.empty() || tag == "?" || tag == "!") return;
  throw TextFault(at(mark), "found a tag (a word after an exclamation mark); allowed: no tags");
}

void TreeBuilder::OnDocumentStart(const YAML::Mark& mark) {
  if (started_) throw TextFault(at(mark), "found a second document; allowed: one in a file");
  started_ = true;
}

void TreeBuilder::OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) {
  if (expects_key()) throw TextFault(at(mark), "found an empty key; allowed: a name");
  Node& node = add(Node::Kind::null, mark);
  // yaml-cpp gives a missing value the mark of the next token, which may be lines below.
  if (!open_.empty() && open_.back().key) {
    const Position& key = open_.back().key->position;
    if (key.line != node.position.line) node.position = key;
  }
  complete(node, anchor);
}

void TreeBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) {
  if (expects_key()) throw TextFault(at(mark), "found an alias as a key; allowed: a name");
  const Node* node = anchor < anchored_.size() ? anchored_[anchor] : nullptr;
  if (node == nullptr) {
    throw TextFault(at(mark),
                    "found an alias inside what it stands for; allowed: an alias of "
                    "something complete");
  }
  if (static_cast<int>(open_.size()) + node->height > deepest) {
    throw TextFault(at(mark), "found nesting deeper than 32 levels; allowed: at most 32");
  }
  complete(*node, YAML::NullAnchor);
}

void TreeBuilder::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                           const std::string& value) {
  refuse_tag(tag, mark);
  if (expects_key()) {
    open_.back().key = Key{value, at(mark)};
    return;
  }
  Node& node = add(Node::Kind::scalar, mark);
  node.text = value;
  node.quoted = tag == "!";
  complete(node, anchor);
}

void TreeBuilder::OnSequenceStart(const YAML::Mark& mark, const std::string& tag,
                                  YAML::anchor_t anchor, YAML::EmitterStyle::value /*style*/) {
  open(Node::Kind::sequence, mark, tag, anchor);
}

void TreeBuilder::OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                             YAML::EmitterStyle::value /*style*/) {
  open(Node::Kind::mapping, mark, tag, anchor);
}

void TreeBuilder::open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
                       YAML::anchor_t anchor) {
  refuse_tag(tag, mark);
  if (static_cast<int>(open_.size()) >= deepest) {
    throw TextFault(at(mark), "found nesting deeper than 32 levels; allowed: at most 32");
  }
  if (expects_key()) {
    throw TextFault(at(mark),
                    kind == Node::Kind::mapping
                        ? "found a mapping as a key, or one without its }; allowed: a name"
                        : "found a list as a key, or one without its ]; allowed: a name");
  }
  open_.push_back({&add(kind, mark), anchor, {}});
}

void TreeBuilder::close() {
  const Open closed = std::move(open_.back());
  open_.pop_back();
  complete(*closed.node, closed.anchor);
}

void TreeBuilder::complete(const Node& node, YAML::anchor_t anchor) {
  if (anchor != YAML::NullAnchor) {
    if (anchored_.size() <= anchor) anchored_.resize(anchor + 1);
    anchored_[anchor] = &node;
  }
  if (open_.empty()) {
    root_ = &node;
    return;
  }
  Open& parent = open_.back();
  parent.node->height = std::max(parent.node->height, node.height + 1);
  if (parent.node->kind == Node::Kind::sequence) {
    parent.node->items.push_back(&node);
  } else {
    parent.node->entries.push_back({std::move(parent.key->name), parent.key->position, &node});
    parent.key.reset();
  }
}

}  // namespace bbsim::yaml
