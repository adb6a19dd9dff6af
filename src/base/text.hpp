// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Common operations on text, which may be invalid UTF-8, and foreign text made safe for terminals,
// messages and shells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bbsim {

// The text without blanks and tabs at both ends. Blank text gives an empty view at its end.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// The lines of the text without line breaks. Text after the last break, if any, is a line too.
[[nodiscard]] inline std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

// The parts between the separators: one more than there are separators.
[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text,
                                                         std::string_view separator) {
  std::vector<std::string_view> parts;
  for (auto end = text.find(separator); end != text.npos; end = text.find(separator)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + separator.size());
  }
  parts.push_back(text);
  return parts;
}

// The texts in one line, with ", " between them; of other items, the texts that `as` makes of them.
template <class Items, class As = std::identity>
[[nodiscard]] std::string joined(const Items& items, As as = {}) {
  std::string all;
  bool first = true;
  for (const auto& item : items) {
    if (!std::exchange(first, false)) all += ", ";
    all += std::invoke(as, item);
  }
  return all;
}

// The text with its ASCII letters in lower case.
[[nodiscard]] inline std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

// "1 row", "2 rows"
[[nodiscard]] inline std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

// Whether a byte of UTF-8 continues a character.
[[nodiscard]] inline bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

// A character of text that may be invalid UTF-8.
struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // 0: no valid character
};

// The first character of a nonempty text.
[[nodiscard]] Utf8Character first_character(std::string_view text);

// Replaces everything that a terminal would act on with an escape such as \x1b: control characters
// except line breaks and tabs; bytes that are not UTF-8 (some terminals treat 0x80 to 0x9f as
// control characters); and characters that change the direction of text, which can disguise a name.
[[nodiscard]] std::string printable(std::string_view text);

// The text as one line of printable ASCII, with other bytes escaped, for a comment in a program.
[[nodiscard]] std::string printable_ascii(std::string_view text);

// The text on one line, safe for a terminal (printable()), cut off after `longest` bytes.
[[nodiscard]] std::string shown(std::string_view text, std::size_t longest = 60);

// shown() in quotation marks; "nothing" for an empty text.
[[nodiscard]] std::string quoted(std::string_view text, std::size_t longest = 60);

// The length for messages of other programs.
inline constexpr std::size_t longest_saying = 200;

// The length for text that must not be cut off, such as a file name.
inline constexpr std::size_t uncut = static_cast<std::size_t>(-1);

// The text as one word, in single quotes if it needs them.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace bbsim
