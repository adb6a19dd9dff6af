// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Text of others within our sentences: on one line, without what a terminal acts on.
#include "base/shown.hpp"
#include "catch.hpp"

using bbsim::quoted;
using bbsim::shown;
using bbsim::uncut;

TEST_CASE("what a terminal would act on is shown as an escape") {
  CHECK(shown("plain text, ψ > 90°") == "plain text, ψ > 90°");
  CHECK(shown("\x1b[31mred\x07") == "\\x1b[31mred\\x07");
  CHECK(shown("two\nlines\tand a tab\r") == "two\\nlines\\tand a tab\\x0d");
  CHECK(shown("\u009b31m") == "\\u009b31m");            // as good as ESC [ to some terminals
  CHECK(shown("\x9b") == "\\x9b");                      // the same, where text is not UTF-8
  CHECK(shown("a\u202ecsv.exe") == "a\\u202ecsv.exe");  // turns the direction
  CHECK(shown("\\x1b") == "\\x1b");                     // what is an escape already stays one
}

TEST_CASE("long text is cut between characters") {
  CHECK(shown("abcdef", 3) == "abc...");
  CHECK(shown("abc", 3) == "abc");
  CHECK(shown("aψb", 2) == "a...");
  CHECK(shown(std::string(1000, 'a'), uncut) == std::string(1000, 'a'));
  CHECK(shown(std::string(1000, 'a')).size() == 63);
}

TEST_CASE("quoted text, and none") {
  CHECK(quoted("a\n") == "\"a\\n\"");
  CHECK(quoted("") == "nothing");
  CHECK(quoted("abcdef", 3) == "\"abc...\"");
}
