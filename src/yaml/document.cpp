// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/document.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <utility>

#include "base/text.hpp"

namespace bbsim::yaml {
namespace {

// More than any scenario needs, in little memory.
constexpr std::size_t most_nodes = 100'000;

// Builds the tree of one document. Throws TextFault for content that a scenario may not hold.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(int source, Nodes& nodes) : source_(source), nodes_(nodes) {}

  [[nodiscard]] const Node* root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (started_) throw TextFault(at(mark), "found a second document; allowed: one in a file");
    started_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) throw TextFault(at(mark), "found an empty key; allowed: a name");
    Node& node = add(Node::Kind::null, mark);
    // yaml-cpp gives a missing value the mark of the next token, which may be lines below.
    if (!open_.empty() && open_.back().key) {
      const Position& key = open_.back().key->position;
      if (key.line != node.position.line) node.position = key;
    }
    complete(node, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
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

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
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

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(Node::Kind::sequence, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(Node::Kind::mapping, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Key {
    std::string name;
    Position position;
  };
  struct Open {  // a sequence or mapping that has not ended
    Node* node;
    YAML::anchor_t anchor;
    std::optional<Key> key;  // of a mapping: read, but still without its value
  };

  [[nodiscard]] Position at(const YAML::Mark& mark) const {
    return {source_, std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
  }

  [[nodiscard]] bool expects_key() const {
    return !open_.empty() && open_.back().node->kind == Node::Kind::mapping && !open_.back().key;
  }

  Node& add(Node::Kind kind, const YAML::Mark& mark) {
    if (nodes_.size() >= most_nodes) {
      throw TextFault(at(mark), "found more than 100000 values; allowed: at most that many");
    }
    Node& node = nodes_.emplace_back();
    node.kind = kind;
    node.position = at(mark);
    return node;
  }

  // yaml-cpp gives plain nodes without a tag the tag "?" or none, and quoted nodes "!".
  void refuse_tag(const std::string& tag, const YAML::Mark& mark) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw TextFault(at(mark), "found a tag (a word after an exclamation mark); allowed: no tags");
  }

  void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
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

  void close() {
    const Open closed = std::move(open_.back());
    open_.pop_back();
    complete(*closed.node, closed.anchor);
  }

  void complete(const Node& node, YAML::anchor_t anchor) {
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

  int source_;
  Nodes& nodes_;
  const Node* root_ = nullptr;
  bool started_ = false;
  std::vector<Open> open_;
  std::vector<const Node*> anchored_;  // by anchor; nullptr while the node is open
};

struct Explanation {
  std::string_view yaml_cpp;  // the start of yaml-cpp's message
  std::string_view plain;
};

std::string plain_message(const std::string& message) {
  static const std::array explanations = {
      Explanation{YAML::ErrorMsg::END_OF_MAP_FLOW, "found no } or comma where one belongs"},
      Explanation{YAML::ErrorMsg::END_OF_SEQ_FLOW, "found no ] or comma where one belongs"},
      Explanation{YAML::ErrorMsg::FLOW_END, "found a ] or } that closes nothing"},
      Explanation{YAML::ErrorMsg::END_OF_MAP,
                  "found no key where one belongs; allowed: key: value, indented like the keys "
                  "above it"},
      Explanation{YAML::ErrorMsg::END_OF_SEQ,
                  "found no list item where one belongs; allowed: - value, indented like the items "
                  "above it"},
      Explanation{YAML::ErrorMsg::MAP_VALUE,
                  "found a colon where no key can end; check the indentation, and put a text that "
                  "holds a colon in quotes"},
      Explanation{YAML::ErrorMsg::MAP_KEY,
                  "found a key where none can stand; check the indentation"},
      Explanation{YAML::ErrorMsg::BLOCK_ENTRY,
                  "found a list item where none can stand; check the indentation"},
      Explanation{YAML::ErrorMsg::EOF_IN_SCALAR,
                  "found a quoted text whose closing quote is missing"},
      Explanation{YAML::ErrorMsg::DOC_IN_SCALAR, "found --- or ... inside a quoted text"},
      Explanation{YAML::ErrorMsg::UNKNOWN_TOKEN,
                  "found a character that begins no YAML value; put the text in quotes"},
      Explanation{YAML::ErrorMsg::UNKNOWN_ANCHOR,
                  "found an alias of something not defined before it"},
      Explanation{YAML::ErrorMsg::INVALID_ESCAPE,
                  "found an unknown escape in a quoted text; use single quotes, or a double "
                  "backslash"},
  };
  for (const Explanation& explanation : explanations) {
    if (message.starts_with(explanation.yaml_cpp)) return std::string(explanation.plain);
  }
  return "found text that is not YAML (" + message + ")";
}

// The position of yaml-cpp's mark, limited to the end of the text.
Position position(const YAML::Mark& mark, std::string_view text, int source) {
  const auto last = static_cast<int>(std::ranges::count(text, '\n'));
  if (mark.line <= last) return {source, std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
  const std::size_t newline = text.rfind('\n');
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  return {source, last + 1, static_cast<int>(text.size() - begin) + 1};
}

std::string hexadecimal(unsigned value) {
  constexpr std::string_view digits = "0123456789abcdef";
  return {'0', 'x', digits[value >> 4U], digits[value & 15U]};
}

bool is_control(unsigned value) {
  return (value < 0x20 && value != '\t' && value != '\n' && value != '\r') || value == 0x7F;
}

bool is_utf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

// The place of a tab in the indentation of the line that begins at `line`, or npos. Blank lines and
// comments have no significant indentation.
std::size_t indenting_tab(std::string_view text, std::size_t line) {
  const std::size_t end = text.find_first_not_of(" \t", line);
  if (end == std::string_view::npos || text[end] == '\n' || text[end] == '\r' || text[end] == '#') {
    return std::string_view::npos;
  }
  const std::size_t tab = text.substr(line, end - line).find('\t');
  return tab == std::string_view::npos ? tab : line + tab;
}

Position position(std::string_view text, std::size_t at, int source) {
  Position result{source, 1, 1};
  for (std::size_t i = 0; i < at; ++i) {
    ++result.column;
    if (text[i] == '\n') {
      ++result.line;
      result.column = 1;
    }
  }
  return result;
}

}  // namespace

std::size_t offset_of(std::string_view text, const Position& position) {
  std::size_t line_start = 0;
  for (int line = 1; line < position.line; ++line) {
    const std::size_t newline = text.find('\n', line_start);
    if (newline == std::string_view::npos) return text.size();
    line_start = newline + 1;
  }
  return std::min(text.size(), line_start + static_cast<std::size_t>(position.column - 1));
}

const Node* parse_yaml(std::string_view text, int source, Nodes& nodes) {
  TreeBuilder builder(source, nodes);
  try {
    // The comment terminates open constructs on the last line. Without it, yaml-cpp overlooks a
    // missing closing quote there and reads an unclosed list as a key.
    std::istringstream stream{std::string(text) + "\n#"};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const TextFault&) {
    throw;
  } catch (const YAML::Exception& e) {
    throw TextFault(position(e.mark, text, source), plain_message(e.msg));
  } catch (const std::exception& e) {  // for example, a number out of range in a directive
    throw TextFault({source, 1, 1}, "found text that is not YAML (" + std::string(e.what()) + ")");
  }
  return builder.root();
}

std::string flow_text(const Node& node) {
  std::string text;
  switch (node.kind) {
    case Node::Kind::null:
      return "null";
    case Node::Kind::scalar: {
      // A plain text may hold what ends it in flow style.
      if (!node.quoted && node.text.find_first_of(",[]{}") == std::string::npos) return node.text;
      for (const char c : node.text) text += c == '\'' ? std::string("''") : std::string(1, c);
      return '\'' + text + '\'';
    }
    case Node::Kind::sequence:
      return '[' + joined(node.items, [](const Node* item) { return flow_text(*item); }) + ']';
    case Node::Kind::mapping:
      return '{' +
             joined(node.entries,
                    [](const Entry& entry) { return entry.key + ": " + flow_text(*entry.value); }) +
             '}';
  }
  return text;
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

std::string_view check_text(std::string_view text, int source) {
  if (is_utf16(text)) {
    throw TextFault({source, 1, 1}, "found UTF-16; allowed: text saved as UTF-8");
  }
  text = without_byte_order_mark(text);

  std::size_t line = std::string_view::npos;  // one before the first
  for (std::size_t i = 0; i < text.size();) {
    if (i == line + 1) {
      const std::size_t tab = indenting_tab(text, i);
      if (tab != std::string_view::npos) {
        throw TextFault(position(text, tab, source),
                        "found a tab in the indentation; allowed: spaces");
      }
    }
    const unsigned value = static_cast<unsigned char>(text[i]);
    const std::size_t length = first_character(text.substr(i)).length;
    if (length == 0 || is_control(value)) {
      throw TextFault(position(text, i, source),
                      "found the byte " + hexadecimal(value) + "; allowed: text in UTF-8");
    }
    if (value == '\n') line = i;
    i += length;
  }
  return text;
}

}  // namespace bbsim::yaml
