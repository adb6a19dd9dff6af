// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Parses YAML text into a tree of nodes with their positions. Only this room uses yaml-cpp.
#pragma once

#include <cstddef>
#include <deque>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::yaml {

// A place in the scenario's text (source 0) or in override number `source` (from 1). Lines and
// columns count from 1; columns count bytes.
struct Position {
  int source = 0;
  int line = 1, column = 1;
};

// The place in the text; its end if the text has fewer lines or a shorter last line.
[[nodiscard]] std::size_t offset_of(std::string_view text, const Position& position);

struct Node;

struct Entry {
  std::string key;
  Position position;  // of the key
  const Node* value = nullptr;
};

struct Node {
  enum class Kind { null, scalar, sequence, mapping } kind = Kind::null;
  bool quoted = false;  // a scalar in quotes, or a block scalar
  bool absent = false;  // null from an override, which removes this key; its name is still checked
  int height = 0;       // levels of nodes below this one
  Position position;
  std::string text;                // of a scalar
  std::vector<const Node*> items;  // of a sequence
  std::vector<Entry> entries;      // of a mapping, in the order of the text; a key may occur twice
};

// The node as YAML in one line, in flow style.
[[nodiscard]] std::string flow_text(const Node& node);

// Owns the nodes of a scenario and its overrides. Aliases share one node.
using Nodes = std::deque<Node>;

// The text is not YAML, or exceeds the limits of a scenario.
struct TextFault : std::runtime_error {
  TextFault(Position at, const std::string& message) : std::runtime_error(message), position(at) {}
  Position position;
};

// The deepest nesting accepted. It is limited because yaml-cpp and the readers recurse.
inline constexpr int deepest = 32;

// Parses one YAML document; returns nullptr if the text holds none. Refuses tags and shares the
// nodes of aliases. Throws TextFault. The text must have passed check_text().
[[nodiscard]] const Node* parse_yaml(std::string_view text, int source, Nodes& nodes);

[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

// Returns the text without a byte order mark. Throws TextFault unless the text is
// UTF-8 without control characters and without tabs in indentation.
[[nodiscard]] std::string_view check_text(std::string_view text, int source);

}  // namespace bbsim::yaml
