// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/printable.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

#include "base/utf8.hpp"

namespace bbsim {
namespace {

bool is_control(std::uint32_t code) {
  if (code == '\n' || code == '\t') return false;
  return code < 0x20 || (code >= 0x7F && code < 0xA0);
}

// Direction marks, embeddings, overrides and isolates; line and paragraph separators.
bool redirects(std::uint32_t code) {
  return code == 0x061C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

void append_escape(std::string& result, const char* format, unsigned value) {
  std::array<char, 16> escape{};
  const int size = std::snprintf(escape.data(), escape.size(), format, value);
  result.append(escape.data(), static_cast<std::size_t>(size));
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character next = first_character(text);
    if (next.length == 0) {
      append_escape(result, "\\x%02x", static_cast<unsigned char>(text[0]));
    } else if (is_control(next.code) && next.code < 0x80) {
      append_escape(result, "\\x%02x", next.code);
    } else if (is_control(next.code) || redirects(next.code)) {
      append_escape(result, "\\u%04x", next.code);
    } else {
      result += text.substr(0, next.length);
    }
    text.remove_prefix(next.length == 0 ? 1 : next.length);
  }
  return result;
}

std::string printable_ascii(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c >= ' ' && c <= '~') {
      result += c;
    } else {
      append_escape(result, "\\x%02x", static_cast<unsigned char>(c));
    }
  }
  return result;
}

}  // namespace bbsim
