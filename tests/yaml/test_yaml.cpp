// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// YAML that is not a scenario is refused at its place, in plain words.
#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_yaml {

using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

const std::string known = "a mapping with title, gravity, ball, ";  // and so on

}  // namespace

TEST_CASE("a file without a mapping") {
  for (const std::string text : {"", "\n\n", "# nothing\n", "  \n# nothing"}) {
    CHECK_THAT(errors(text), Contains("scenario.yaml:1:1: found an empty file; allowed: " + known));
  }
  CHECK_THAT(errors("--- ~\n"), Contains("scenario.yaml:1:5: found nothing; allowed: " + known));
  CHECK_THAT(errors("- 1\n- 2\n"),
             Contains("scenario.yaml:1:1: found a list of 2; allowed: " + known));
  CHECK_THAT(errors("# x\nabc\n"), Contains("scenario.yaml:2:1: found abc; allowed: " + known));
}

TEST_CASE("bytes that are not text") {
  using namespace std::string_literals;
  CHECK(errors("title: a\0b\n"s) ==
        "scenario.yaml:1:9: found the byte 0x00; allowed: text in UTF-8");
  CHECK(errors("title: a\ngravity: \xff\n") ==
        "scenario.yaml:2:10: found the byte 0xff; allowed: text in UTF-8");
  CHECK(errors("\xFF\xFEt\0i\0"s) ==
        "scenario.yaml:1:1: found UTF-16; allowed: text saved as UTF-8");
  const std::vector<std::string> malformed = {
      "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\xF0\x9F\x98", "\x80", "\x7F"};
  for (const std::string& bytes : malformed) {
    CHECK_THAT(errors("title: " + bytes), Contains("allowed: text in UTF-8"));
  }
}

TEST_CASE("byte order marks and line ends from editors are accepted") {
  CHECK(errors("\xEF\xBB\xBF" + open_loop).empty());
  std::string lines_of_windows;
  for (const char c : open_loop) lines_of_windows += c == '\n' ? "\r\n" : std::string(1, c);
  CHECK(errors(lines_of_windows).empty());
  CHECK(errors("---\n" + open_loop + "...\n").empty());
  CHECK(errors("\t# a comment\n" + open_loop + "\t\n").empty());
  CHECK(errors("title: \U0001F3B1\n" + open_loop).empty());
}

TEST_CASE("tabs do not indent") {
  CHECK(errors("ball:\n\tradius: 0.01\n") ==
        "scenario.yaml:2:1: found a tab in the indentation; allowed: spaces");
  CHECK(errors("ball:\n  \tradius: 0.01\n") ==
        "scenario.yaml:2:3: found a tab in the indentation; allowed: spaces");
}

TEST_CASE("malformed YAML is explained at its place") {
  CHECK(errors("ball: {radius: 1\ntime: 2\n") ==
        "scenario.yaml:2:5: found no } or comma where one belongs");
  CHECK(errors("a: [1, 2\n") == "scenario.yaml:2:1: found no ] or comma where one belongs");
  CHECK(errors("a: 1 ]\n]\n") == "scenario.yaml:2:1: found a ] or } that closes nothing");
  CHECK(errors("title: a: b\n") ==
        "scenario.yaml:1:9: found a colon where no key can end; check the indentation, and put a "
        "text that holds a colon in quotes");
  CHECK(errors("ball:\n  radius: 1\n mass: 2\n") ==
        "scenario.yaml:3:2: found no key where one belongs; allowed: key: value, indented like the "
        "keys above it");
  CHECK_THAT(errors("title: \"a\n"), Contains("closing quote is missing"));
  CHECK_THAT(errors("title: @a\n"), Contains("put the text in quotes"));
  CHECK_THAT(errors("title: \"\\q\"\n"), Contains("unknown escape"));
}

TEST_CASE("YAML beyond what a scenario needs") {
  CHECK(errors("a: 1\n---\nb: 1\n") ==
        "scenario.yaml:2:1: found a second document; allowed: one in a file");
  CHECK(errors("a: !!float 1\n") ==
        "scenario.yaml:1:4: found a tag (a word after an exclamation mark); allowed: no tags");
  CHECK(errors("[a]: 1\n") ==
        "scenario.yaml:1:1: found a list as a key, or one without its ]; allowed: a name");
  CHECK(errors("{a: 1}: 1\n") ==
        "scenario.yaml:1:1: found a mapping as a key, or one without its }; allowed: a name");
  CHECK(errors("~: 1\n") == "scenario.yaml:1:1: found an empty key; allowed: a name");
  CHECK(errors(open_loop + "solver: &a {}\n*a : 1\n") ==
        "scenario.yaml:5:1: found an alias as a key; allowed: a name");
  CHECK_THAT(errors(open_loop + "solver: {<<: {rtol: 1e-3}}\n"),
             Contains("scenario.yaml:4:10: solver.<<: unknown key; known keys here: method"));
}

TEST_CASE("aliases repeat their anchors") {
  const auto scenario = parse(
      "ball: {radius: &r 2 cm, position: [*r, *r]}\n"
      "time: {end: 1, step: 1}\n"
      "gimbal: {motion: {phi: &p {ramp: {start: 0, rate: 1}}, theta: *p}}\n");
  CHECK(scenario.ball.position == bbsim::Pair{0.02, 0.02});
  CHECK(std::get<bbsim::Ramp>(scenario.gimbal.motion->theta[0]).rate == 1);
  CHECK(errors("a: *b\n") ==
        "scenario.yaml:1:4: found an alias of something not defined before it");
  CHECK(errors("a: &a [*a]\n") ==
        "scenario.yaml:1:8: found an alias inside what it stands for; allowed: an alias of "
        "something complete");
}

}  // namespace bbsim_test::test_yaml
