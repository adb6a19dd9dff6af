// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fonts.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/external.hpp"

namespace bbsim::app {
namespace {

struct Letters {
  std::uint32_t first, last;
};

// One line per font, with hexadecimal ranges: "20-7e a0 a2-17f".
std::vector<Letters> letters_of_fonts() {
  const std::optional<file::Finished> listed =
      file::run_program({"fc-list", "--format", "%{charset}\n"}, "", "list the fonts");
  std::vector<Letters> letters;
  if (!listed || !listed->well()) return letters;
  const char* at = listed->output.data();
  const char* const end = at + listed->output.size();
  while (at < end) {
    constexpr int hexadecimal = 16;
    Letters range{};
    auto read = std::from_chars(at, end, range.first, hexadecimal);
    if (read.ptr == at) {
      ++at;  // a blank, or the end of a line
      continue;
    }
    range.last = range.first;
    if (read.ptr < end && *read.ptr == '-') {
      read = std::from_chars(read.ptr + 1, end, range.last, hexadecimal);
    }
    letters.push_back(range);
    at = read.ptr;
  }
  return letters;
}

}  // namespace

bool some_font_has(std::uint32_t code) {
  static const std::vector<Letters> all = letters_of_fonts();
  return std::ranges::any_of(
      all, [code](const Letters& range) { return range.first <= code && code <= range.last; });
}

}  // namespace bbsim::app
