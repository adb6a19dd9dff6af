// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/document.hpp"

#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "yaml/tree_builder.hpp"

namespace bbsim::yaml {
namespace {

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

}  // namespace

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
  const auto separate = [&text] { text += text.empty() ? "" : ", "; };
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
      for (const Node* const item : node.items) {
        separate();
        text += flow_text(*item);
      }
      return '[' + text + ']';
    case Node::Kind::mapping:
      for (const Entry& entry : node.entries) {
        separate();
        text += entry.key + ": " + flow_text(*entry.value);
      }
      return '{' + text + '}';
  }
  return text;
}

}  // namespace bbsim::yaml
