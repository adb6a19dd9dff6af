// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Text for terminals, with escapes in place of control characters.
#include <string>

#include "base/quoted.hpp"
#include "catch.hpp"

namespace bbsim_test::test_printable {

using bbsim::printable;

TEST_CASE("plain text, in any script, stays as it is") {
  for (const std::string text :
       {"", "a line\nand another\twith a tab", "\u03b3 = 0.1\u00b0 \u2265 0", "\u7403.yaml",
        "\U0001F3B1", "~ \\x1b written out", "\u00a0"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("terminal control characters are escaped") {
  CHECK(printable("\x1b[31mred\x1b[0m") == "\\x1b[31mred\\x1b[0m");
  CHECK(printable("\x1b]0;title\x07") == "\\x1b]0;title\\x07");
  CHECK(printable("over\rwritten\b\x7f") == "over\\x0dwritten\\x08\\x7f");
  CHECK(printable(std::string("nul\0", 4)) == "nul\\x00");
  CHECK(printable("\u009b31m") == "\\u009b31m");  // CSI as one character
}

TEST_CASE("a comment in a program has everything but printable ASCII escaped") {
  CHECK(bbsim::printable_ascii("a b~.yaml") == "a b~.yaml");
  CHECK(bbsim::printable_ascii("a\n\tb\x7f") == "a\\x0a\\x09b\\x7f");
  CHECK(bbsim::printable_ascii("\u03b3\xff") == "\\xce\\xb3\\xff");
}

TEST_CASE("characters that change the direction of writing are escaped") {
  CHECK(printable("\u202egpj.exe") == "\\u202egpj.exe");
  CHECK(printable("a\u2066b\u2069\u200f\u061c") == "a\\u2066b\\u2069\\u200f\\u061c");
  CHECK(printable("line\u2028separator") == "line\\u2028separator");
}

TEST_CASE("bytes that are not UTF-8 are escaped one by one") {
  CHECK(printable("caf\xe9") == "caf\\xe9");  // Latin-1
  CHECK(printable("\x9b"
                  "31m") == "\\x9b31m");                           // CSI of an 8-bit terminal
  CHECK(printable("\xc0\x9b") == "\\xc0\\x9b");                    // overlong form
  CHECK(printable("\xe0\x9f\xbf") == "\\xe0\\x9f\\xbf");           // overlong form
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // half of a surrogate pair
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  CHECK(printable("\xe2\x82") == "\\xe2\\x82");                    // cut off
  CHECK(printable("\xe2\x82z") == "\\xe2\\x82z");
}

TEST_CASE("escaping printable text again changes nothing") {
  const std::string once = printable("\x1b\xe9\u202e\n");
  CHECK(printable(once) == once);
}

}  // namespace bbsim_test::test_printable
