// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Parses JSON from outside. Only rooms that link nlohmann_json can include this header.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

namespace bbsim {

// The deepest nesting that is accepted. Comparing, copying and writing a value recurse.
inline constexpr std::size_t deepest_json = 100;

// The nesting depth of JSON text. Meaningless for other text.
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

// The value of the text. If the text is not JSON or nests deeper than deepest_json, the result is
// discarded: is_discarded() is true, and no other use is allowed. All JSON from outside goes
// through this function.
[[nodiscard]] inline nlohmann::ordered_json parse_json(std::string_view text) {
  using Json = nlohmann::ordered_json;
  if (json_depth(text) > deepest_json) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, false);
}

}  // namespace bbsim
