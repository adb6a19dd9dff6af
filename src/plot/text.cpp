// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "base/utf8.hpp"

namespace bbsim::plot {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

struct Block {
  std::uint32_t first, last;
};

template <std::size_t count>
bool is_in(const std::array<Block, count>& blocks, std::uint32_t code) {
  return std::ranges::any_of(
      blocks, [code](const Block& block) { return code >= block.first && code <= block.last; });
}

constexpr std::array controls = {Block{0, 0x1F}, Block{0x7F, 0x9F}, Block{0x2028, 0x2029}};

// Unprintable: not a character, or one that changes the display of its neighbors.
constexpr std::array hostile = {Block{0x200B, 0x200F}, Block{0x202A, 0x202E}, Block{0x2066, 0x2069},
                                Block{0xFDD0, 0xFDEF}, Block{0xFEFF, 0xFEFF}};

bool is_hostile(std::uint32_t code) {
  return (code & 0xFFFEU) == 0xFFFE || is_in(hostile, code);
}

// Characters that DejaVu Sans certainly has: Latin, Greek and Cyrillic, punctuation, superscripts,
// arrows, mathematics.
constexpr std::array in_dejavu = {
    Block{0x20, 0x7E},     Block{0xA0, 0x2E9},    Block{0x300, 0x34F},   Block{0x38E, 0x3A1},
    Block{0x3A3, 0x525},   Block{0x2010, 0x205E}, Block{0x2070, 0x2070}, Block{0x2074, 0x208E},
    Block{0x2190, 0x22FF}, Block{0xFFFD, 0xFFFD}};

// Widths in hundredths of the font's size, from the blank to the tilde, in DejaVu Sans, the widest
// of the usual fonts.
constexpr std::array<unsigned char, 95> widths = {
    32, 41, 46, 84, 64, 96, 78, 28, 40,  40, 50, 84, 32, 37, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64,
    64, 64, 34, 34, 84, 84, 84, 54, 100, 69, 69, 70, 77, 64, 58, 78, 76, 30, 30, 66, 56, 87, 75, 79,
    61, 79, 70, 64, 62, 74, 69, 99, 69,  62, 69, 40, 34, 40, 84, 50, 50, 62, 64, 55, 64, 62, 36, 64,
    64, 28, 28, 58, 28, 98, 64, 62, 64,  64, 42, 53, 40, 64, 60, 82, 60, 60, 53, 64, 34, 64, 84};

double part_of_size(std::uint32_t code) {
  if (code >= 0x20 && code < 0x7F) return widths[code - 0x20] / 100.0;
  if (code >= 0x300 && code < 0x370) return 0;                       // combining
  if (code < 0x250 || (code >= 0x370 && code < 0x400)) return 0.68;  // Latin, Greek
  return 1.0;
}

struct Letter {
  std::string_view text;
  std::uint32_t code;  // U+FFFD for an invalid byte
};

std::vector<Letter> letters_of(std::string_view text) {
  std::vector<Letter> letters;
  while (!text.empty()) {
    const Utf8Character next = first_character(text);
    letters.push_back(next.length == 0 ? Letter{replacement, 0xFFFD}
                                       : Letter{text.substr(0, next.length), next.code});
    text.remove_prefix(std::max<std::size_t>(next.length, 1));
  }
  return letters;
}

}  // namespace

std::string clean(std::string_view text) {
  std::string result;
  for (const Letter& letter : letters_of(text)) {
    if (!is_in(controls, letter.code)) {
      result += is_hostile(letter.code) ? replacement : letter.text;
    } else if (!result.empty() && result.back() != ' ') {
      result += ' ';
    }
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

std::string with_letters(std::string_view text,
                         const std::function<bool(std::uint32_t)>& has_letter) {
  std::string result;
  for (const Letter& letter : letters_of(text)) {
    const bool known = is_in(in_dejavu, letter.code) || has_letter(letter.code);
    result += known ? letter.text : replacement;
  }
  return result;
}

double width_of(std::string_view text, double size, double narrowest) {
  double parts = 0;
  for (const Letter& letter : letters_of(text)) {
    parts += std::max(part_of_size(letter.code), narrowest);
  }
  return parts * size;
}

std::string cut(const std::string& text, double width, double size, double narrowest) {
  if (width_of(text, size, narrowest) <= width) return text;
  const std::vector<Letter> letters = letters_of(text);
  for (std::size_t keep = letters.size() - 1; keep > 0; --keep) {
    const std::size_t after = keep / 2, before = keep - after;
    std::string kept;
    for (std::size_t i = 0; i < letters.size(); ++i) {
      if (i == before) kept += "…";
      if (i < before || i >= letters.size() - after) kept += letters[i].text;
    }
    if (width_of(kept, size, narrowest) <= width) return kept;
  }
  return "…";
}

std::string number(double value, int digits) {
  char plain[40];
  std::snprintf(plain, sizeof plain, "%.*g", digits, value);
  std::string text;
  for (const char c : std::string_view(plain)) text += c == '-' ? "−" : std::string(1, c);
  return text;
}

std::string power_of_ten(int exponent) {
  constexpr std::string_view raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  for (const char c : std::to_string(exponent)) {
    text += c == '-' ? std::string_view("⁻") : raised[c - '0'];
  }
  return text;
}

}  // namespace bbsim::plot
