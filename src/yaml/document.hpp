// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// YAML text -> a tree of nodes that know where they stand. The only user of yaml-cpp.
#pragma once

#include <deque>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::yaml {

// A place in the scenario's text (source 0) or in the i-th override (source i, from 1).
// Lines and columns count from 1; columns count bytes.
struct Position {
  int source = 0;
  int line = 1, column = 1;
};

struct Node;

struct Entry {
  std::string key;
  Position position;  // of the key
  const Node* value = nullptr;
};

struct Node {
  enum class Kind { null, scalar, sequence, mapping } kind = Kind::null;
  bool quoted = false;  // a scalar in quotes, or a block of text
  bool absent = false;  // null: an override leaves out this key, whose name is checked all the same
  int height = 0;       // levels of nodes below this one
  Position position;
  std::string text;                // of a scalar
  std::vector<const Node*> items;  // of a sequence
  std::vector<Entry> entries;      // of a mapping, in its order; a key may stand there twice
};

// Owns the nodes of a scenario and its overrides; a node that an alias repeats is there once.
using Nodes = std::deque<Node>;

// The text is no YAML, or more YAML than a scenario may be.
struct TextFault : std::runtime_error {
  TextFault(Position at, const std::string& message) : std::runtime_error(message), position(at) {}
  Position position;
};

// The deepest nesting that is read. (yaml-cpp and the readers recurse.)
inline constexpr int deepest = 32;

// Reads one YAML document; nullptr if the text holds none. Tags are refused, aliases shared.
// Throws TextFault. The text must have passed check_text (check_text.hpp).
[[nodiscard]] const Node* parse_yaml(std::string_view text, int source, Nodes& nodes);

}  // namespace bbsim::yaml
