// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/text.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace bbsim::plot {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::string_view ellipsis = "\xE2\x80\xA6";
constexpr std::string_view minus = "\xE2\x88\x92";

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};

// The character that begins at `text`'s first byte.
Character first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return {};
  std::uint32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (i >= text.size() || (byte(i) & 0xC0U) != 0x80) return {};
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < smallest[bytes] || surrogate || code > 0x10FFFF) return {};
  return {code, bytes, true};
}

bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x2028 || code == 0x2029;
}

// Not for print: no character at all, or one that changes how its neighbours are written.
bool is_hostile(std::uint32_t code) {
  return (code & 0xFFFEU) == 0xFFFE || (code >= 0xFDD0 && code <= 0xFDEF) ||
         (code >= 0x200B && code <= 0x200F) || (code >= 0x202A && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

// What DejaVu Sans has for certain: Latin, Greek and Cyrillic, punctuation, superscripts, arrows,
// mathematics.
bool in_dejavu(std::uint32_t code) {
  struct Block {
    std::uint32_t first, last;
  };
  constexpr Block blocks[] = {{0x20, 0x7E},     {0xA0, 0x2E9},    {0x300, 0x34F},
                              {0x38E, 0x3A1},   {0x3A3, 0x525},   {0x2010, 0x205E},
                              {0x2074, 0x208E}, {0x2190, 0x22FF}, {0xFFFD, 0xFFFD}};
  for (const Block& block : blocks) {
    if (code >= block.first && code <= block.last) return true;
  }
  return code == 0x2070;  // superscript zero stands alone
}

// Widths in hundredths of the font's size: of DejaVu Sans, the widest of the usual fonts, from the
// blank to the tilde.
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

std::vector<std::string_view> characters_of(std::string_view text) {
  std::vector<std::string_view> characters;
  while (!text.empty()) {
    const std::size_t bytes = first_character(text).bytes;
    characters.push_back(text.substr(0, bytes));
    text.remove_prefix(bytes);
  }
  return characters;
}

// `keep` characters of the text, those before and after the ellipsis.
std::string shortened(const std::vector<std::string_view>& characters, std::size_t before,
                      std::size_t after) {
  std::string text;
  for (std::size_t i = 0; i < before; ++i) text += characters[i];
  text += ellipsis;
  for (std::size_t i = characters.size() - after; i < characters.size(); ++i) text += characters[i];
  return text;
}

std::string cut_to(const std::string& text, double width, double size, bool middle) {
  if (width_of(text, size) <= width) return text;
  const std::vector<std::string_view> characters = characters_of(text);
  for (std::size_t keep = characters.size() - 1; keep > 0; --keep) {
    const std::size_t after = middle ? keep / 2 : 0;
    std::string shorter = shortened(characters, keep - after, after);
    if (width_of(shorter, size) <= width) return shorter;
  }
  return std::string(ellipsis);
}

}  // namespace

std::string clean(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character character = first_character(text);
    if (!character.valid || is_hostile(character.code)) {
      result += replacement;
    } else if (is_control(character.code)) {
      if (!result.empty() && result.back() != ' ') result += ' ';
    } else {
      result += text.substr(0, character.bytes);
    }
    text.remove_prefix(character.bytes);
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

std::string with_letters(std::string_view text,
                         const std::function<bool(std::uint32_t)>& has_letter) {
  std::string result;
  while (!text.empty()) {
    const Character character = first_character(text);
    const bool known = in_dejavu(character.code) || has_letter(character.code);
    result += known ? text.substr(0, character.bytes) : replacement;
    text.remove_prefix(character.bytes);
  }
  return result;
}

double width_of(std::string_view text, double size) {
  double parts = 0;
  while (!text.empty()) {
    const Character character = first_character(text);
    parts += part_of_size(character.code);
    text.remove_prefix(character.bytes);
  }
  return parts * size;
}

std::string cut(const std::string& text, double width, double size) {
  return cut_to(text, width, size, false);
}

std::string cut_middle(const std::string& text, double width, double size) {
  return cut_to(text, width, size, true);
}

std::string number(double value, int digits) {
  char plain[40];
  std::snprintf(plain, sizeof plain, "%.*g", digits, value);
  std::string text;
  for (const char* c = plain; *c != '\0'; ++c) {
    if (*c == '-') {
      text += minus;
    } else {
      text += *c;
    }
  }
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
