// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/text.hpp"

#include <array>
#include <cstdio>

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

Utf8Character first_character(std::string_view text) {
  struct Form {
    unsigned char mask, lead;
    std::uint32_t least;  // codes below it have a shorter form
  };
  constexpr std::array forms = {Form{0x80, 0x00, 0}, Form{0xE0, 0xC0, 0x80},
                                Form{0xF0, 0xE0, 0x800}, Form{0xF8, 0xF0, 0x10000}};
  const auto lead = static_cast<unsigned char>(text[0]);
  for (std::size_t length = 1; length <= forms.size(); ++length) {
    const Form& form = forms[length - 1];
    if ((lead & form.mask) != form.lead) continue;
    std::uint32_t code = lead & ~std::uint32_t{form.mask};
    if (text.size() < length) return {};
    for (std::size_t i = 1; i < length; ++i) {
      const auto next = static_cast<unsigned char>(text[i]);
      if ((next & 0xC0U) != 0x80U) return {};
      code = code << 6U | (next & 0x3FU);
    }
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < form.least || code > 0x10FFFF || surrogate) return {};
    return {code, length};
  }
  return {};
}

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
