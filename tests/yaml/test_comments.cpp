// Comments are made short before the text is parsed: nothing but the time that it takes may show
// it.
#include "catch.hpp"
#include "yaml/comments.hpp"
#include "yaml/document.hpp"

using bbsim::yaml::with_short_comments;

namespace {

std::string value_of(const std::string& text) {
  bbsim::yaml::Nodes nodes;
  const bbsim::yaml::Node* const root = bbsim::yaml::parse_yaml(text, 0, nodes);
  return root->entries.at(0).value->text;
}

bool stays(const std::string& text) {
  return with_short_comments(text) == text;
}

}  // namespace

TEST_CASE("comments on lines of their own are cut to their first character") {
  CHECK(with_short_comments("# one\na: 1\n# it's two\nb: \"x\"  # here\n# three") ==
        "#\na: 1\n#\nb: \"x\"  # here\n#");
  CHECK(with_short_comments("a:\n  - {b: \"1 cm\", c: '2', d: don't}\n# e\n") ==
        "a:\n  - {b: \"1 cm\", c: '2', d: don't}\n#\n");
  CHECK(with_short_comments("# one\r\na: 1\r\n") == "#\na: 1\r\n");
  CHECK(with_short_comments("a: \"90°\"\n# b") == "a: \"90°\"\n#");
  CHECK(with_short_comments("").empty());
}

TEST_CASE("comments that are indented or behind a value stay") {
  CHECK(stays("a: 1  # one\n  # two\n"));
  CHECK(stays("a: |\n  # text\nb: 1\n"));
}

TEST_CASE("where a quoted text may go on to the next line, lines that look like comments stay") {
  CHECK(stays("a: \"one\n# two\"\n"));
  CHECK(stays("a: 'one\n# two'\n"));
  CHECK(stays("a: 'it''s\n# two'\n"));
  CHECK(stays("a: \"\\\"\n# two\"\n"));
  CHECK(stays("{a: \"it's\", b: 'one\n# two'}\n"));
  CHECK(stays("{a: don't, b: 'one\n# two'}\n"));
  CHECK(stays("{a: 5 \", b: \"one\n# two\"}\n"));
  CHECK(stays("\"a\":\"one\n# two\"\n"));
  CHECK(stays("a: 1\r# two\r"));
}

TEST_CASE("what is parsed is what stands in the text") {
  CHECK(value_of("# before\na: \"one\n# two\"\n") == "one # two");
  CHECK(value_of("# before\na: |\n  # text\n# after\n") == "# text\n");
  // A comment ends a text that has no quotes; an empty line would not.
  CHECK_THROWS_AS(value_of("a: one\n# between\n  two\n"), bbsim::yaml::TextFault);
}
