// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Forms of YAML that are read, and bytes that are no text.
// tests/scenario/refused/text.yaml lists what else is refused.
#include "catch.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_yaml {

using namespace bbsim::test;
using Catch::Matchers::Contains;

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

TEST_CASE("an alias stands for its anchor's value") {
  const auto scenario = parse(
      "ball: {radius: &r 2 cm, position: [*r, *r]}\n"
      "time: {end: 1, step: 1}\n"
      "gimbal: {motion: {phi: &p {ramp: {start: 0, rate: 1}}, theta: *p}}\n");
  CHECK(scenario.ball.position == bbsim::Pair{0.02, 0.02});
  CHECK(std::get<bbsim::Ramp>(scenario.gimbal.motion->theta[0]).rate == 1);
}

}  // namespace bbsim_test::test_yaml
