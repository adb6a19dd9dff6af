// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Outside text within bbsim's sentences: on one line, with terminal control characters escaped.
#include "base/quoted.hpp"
#include "catch.hpp"

namespace bbsim_test::test_quoted {

using bbsim::quoted;
using bbsim::shown;
using bbsim::uncut;

TEST_CASE("terminal control characters are shown as escapes") {
  CHECK(shown("plain text, ψ > 90°") == "plain text, ψ > 90°");
  CHECK(shown("\x1b[31mred\x07") == "\\x1b[31mred\\x07");
  CHECK(shown("two\nlines\tand a tab\r") == "two\\nlines\\tand a tab\\x0d");
  CHECK(shown("\u009b31m") == "\\u009b31m");            // some terminals treat it like ESC [
  CHECK(shown("\x9b") == "\\x9b");                      // the same if text is not UTF-8
  CHECK(shown("a\u202ecsv.exe") == "a\\u202ecsv.exe");  // changes the direction of writing
  CHECK(shown("\\x1b") == "\\x1b");                     // an existing escape stays
}

TEST_CASE("long text is cut between characters") {
  CHECK(shown("abcdef", 3) == "abc...");
  CHECK(shown("abc", 3) == "abc");
  CHECK(shown("aψb", 2) == "a...");
  CHECK(shown(std::string(1000, 'a'), uncut) == std::string(1000, 'a'));
  CHECK(shown(std::string(1000, 'a')).size() == 63);
}

TEST_CASE("quoted text and empty text") {
  CHECK(quoted("a\n") == "\"a\\n\"");
  CHECK(quoted("") == "nothing");
  CHECK(quoted("abcdef", 3) == "\"abc...\"");
}

}  // namespace bbsim_test::test_quoted
