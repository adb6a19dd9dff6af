// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/check_text.hpp"

#include <cstddef>
#include <string>

#include "yaml/document.hpp"

namespace bbsim::yaml {
namespace {

unsigned byte(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

bool continues(unsigned value) {
  return (value & 0xC0U) == 0x80U;
}

// The length of the UTF-8 sequence at i, or 0 if the sequence is invalid (RFC 3629: no overlong
// forms, no surrogates, nothing above U+10FFFF).
std::size_t sequence_length(std::string_view text, std::size_t i) {
  const unsigned a = byte(text, i);
  const unsigned b = byte(text, i + 1);
  if (a < 0x80) return 1;
  if (a < 0xC2 || a > 0xF4 || !continues(b)) return 0;
  if (a < 0xE0) return 2;
  if (!continues(byte(text, i + 2))) return 0;
  if (a < 0xF0) {
    const bool overlong = a == 0xE0 && b < 0xA0;
    const bool surrogate = a == 0xED && b >= 0xA0;
    return overlong || surrogate ? 0 : 3;
  }
  const bool out_of_range = (a == 0xF0 && b < 0x90) || (a == 0xF4 && b >= 0x90);
  return out_of_range || !continues(byte(text, i + 3)) ? 0 : 4;
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
    const unsigned value = byte(text, i);
    const std::size_t length = sequence_length(text, i);
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
