// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/quoted.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

#include "base/text.hpp"

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

std::string shown(std::string_view text, std::size_t longest) {
  std::size_t end = text.size();
  if (end > longest) {
    end = longest;
    while (end > 0 && continues_character(text[end])) --end;
  }
  std::string result;
  for (const char c : printable(text.substr(0, end))) {
    if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else {
      result += c;
    }
  }
  return end < text.size() ? result + "..." : result;
}

std::string quoted(std::string_view text, std::size_t longest) {
  return text.empty() ? "nothing" : '"' + shown(text, longest) + '"';
}

std::string shell_word(std::string_view text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,:=+%@-";
  if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) {
    return std::string(text);
  }
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + '\'';
}

}  // namespace bbsim
