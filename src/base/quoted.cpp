// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/quoted.hpp"

#include "base/printable.hpp"

namespace bbsim {
namespace {

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

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

}  // namespace bbsim
