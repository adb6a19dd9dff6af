// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// JSON that others wrote. (For rooms that have nlohmann's library.)
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

namespace bbsim {

// The deepest nesting that is read: whoever compares, copies or writes a value recurses.
inline constexpr std::size_t deepest_json = 100;

// How deep a text of JSON nests. Of what is no JSON it says nothing.
[[nodiscard]] inline std::size_t json_depth(std::string_view text) {
  std::size_t depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      in_string = !in_string;
    } else if (in_string) {
      if (c == '\\') ++i;
    } else if (c == '[' || c == '{') {
      deepest = ++depth > deepest ? depth : deepest;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

// The value of the text; discarded (is_discarded(), and nothing else it is) if the text is no JSON,
// or nests deeper. No text that others wrote is parsed but by this.
[[nodiscard]] inline nlohmann::ordered_json parse_json(std::string_view text) {
  using Json = nlohmann::ordered_json;
  if (json_depth(text) > deepest_json) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, false);
}

}  // namespace bbsim
