// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Outside text made safe for terminals, for bbsim's sentences and for comments in programs.
#include <string>

#include "base/text.hpp"
#include "catch.hpp"

namespace bbsim_test::test_quoted {

using bbsim::printable;
using bbsim::printable_ascii;
using bbsim::quoted;
using bbsim::shown;
using bbsim::uncut;

TEST_CASE("printable text of any script stays, and all else is escaped once") {
  struct Case {
    std::string text, printed;
  };
  const Case cases[] = {
      {"", ""},
      {"a line\nand another\twith a tab", "a line\nand another\twith a tab"},
      {"\u03b3 = 0.1\u00b0 \u2265 0", "\u03b3 = 0.1\u00b0 \u2265 0"},
      {"\u7403.yaml \U0001F3B1 \u00a0", "\u7403.yaml \U0001F3B1 \u00a0"},
      {"~ \\x1b written out", "~ \\x1b written out"},
      {"\x1b[31mred\x1b[0m", "\\x1b[31mred\\x1b[0m"},
      {"\x1b]0;title\x07", "\\x1b]0;title\\x07"},
      {"over\rwritten\b\x7f", "over\\x0dwritten\\x08\\x7f"},
      {std::string("nul\0", 4), "nul\\x00"},
      {"\u009b31m", "\\u009b31m"},  // some terminals treat it like ESC [
      // Directions of writing, and lines that are none.
      {"\u202egpj.exe", "\\u202egpj.exe"},
      {"a\u2066b\u2069\u200f\u061c", "a\\u2066b\\u2069\\u200f\\u061c"},
      {"line\u2028separator", "line\\u2028separator"},
      // Bytes that are not UTF-8: Latin-1, overlong forms, half of a surrogate pair, beyond
      // U+10FFFF, cut off.
      {"caf\xe9", "caf\\xe9"},
      {std::string("\x9b") + "31m", "\\x9b31m"},
      {"\xc0\x9b", "\\xc0\\x9b"},
      {"\xe0\x9f\xbf", "\\xe0\\x9f\\xbf"},
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},
      {"\xe2\x82", "\\xe2\\x82"},
      {"\xe2\x82z", "\\xe2\\x82z"},
  };
  for (const auto& [text, printed] : cases) {
    CAPTURE(printed);
    CHECK(printable(text) == printed);
    CHECK(printable(printed) == printed);
  }
}

TEST_CASE("text in a sentence is on one line, cut between characters, and may be empty") {
  CHECK(shown("two\nlines\tand a tab\r") == "two\\nlines\\tand a tab\\x0d");
  CHECK(shown("\x1b[31m \x9b a\u202ecsv.exe") == "\\x1b[31m \\x9b a\\u202ecsv.exe");
  CHECK(shown("abcdef", 3) == "abc...");
  CHECK(shown("abc", 3) == "abc");
  CHECK(shown("aψb", 2) == "a...");
  CHECK(shown(std::string(1000, 'a'), uncut) == std::string(1000, 'a'));
  CHECK(shown(std::string(1000, 'a')).size() == 63);
  CHECK(quoted("a\n") == "\"a\\n\"");
  CHECK(quoted("") == "nothing");
  CHECK(quoted("abcdef", 3) == "\"abc...\"");
}

TEST_CASE("a comment in a program has everything but printable ASCII escaped") {
  CHECK(printable_ascii("a b~.yaml") == "a b~.yaml");
  CHECK(printable_ascii("a\n\tb\x7f") == "a\\x0a\\x09b\\x7f");
  CHECK(printable_ascii("\u03b3\xff") == "\\xce\\xb3\\xff");
}

}  // namespace bbsim_test::test_quoted
