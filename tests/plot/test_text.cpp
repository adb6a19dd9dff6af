// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "plot/text.hpp"

namespace bbsim_test::test_text {

using namespace bbsim::plot;

TEST_CASE("a text becomes one line of valid UTF-8 without control characters") {
  CHECK(clean("plain, 'quoted' {_a} ^b @c `d` \\n") == "plain, 'quoted' {_a} ^b @c `d` \\n");
  CHECK(clean("two\nlines\t\tand a tab\r\n") == "two lines and a tab");
  CHECK(clean("\x1b[31mred") == "[31mred");
  CHECK(clean("\xff\xfe|\xc3(|\xed\xa0\x80|\xf5\x80\x80\x80|\xc0\xaf") == "��|�(|���|����|��");
  CHECK(clean("left\u202Eright\uFEFF") == "left�right�");
  CHECK(clean("\u2028") == "");
  CHECK(clean("φ − ⁻³ 漢字 😀") == "φ − ⁻³ 漢字 😀");
}

TEST_CASE("a text that is too wide is cut between letters") {
  const std::string long_text = "Ein ziemlich langer Titel mit Umlauten: äöü äöü äöü";
  for (const double room : {20.0, 50.0, 100.0, 300.0}) {
    CAPTURE(room);
    CHECK(width_of(cut(long_text, room, 12), 12) <= room);
    CHECK(clean(cut(long_text, room, 12)).find("�") == std::string::npos);
  }
  CHECK(cut("short", 100, 12) == "short");
  const std::string middle = cut("results-of-monday-17.csv", 100, 12);
  CHECK(middle.starts_with("resu"));
  CHECK(middle.ends_with(".csv"));
  CHECK(cut("anything", 0, 12) == "…");
}

TEST_CASE("numbers have a proper minus sign and superscript powers of ten") {
  CHECK(number(-0.25) == "−0.25");
  CHECK(number(1e-7) == "1e−07");
  CHECK(power_of_ten(-12) == "10⁻¹²");
  CHECK(power_of_ten(303) == "10³⁰³");
}

TEST_CASE("characters missing from every font are replaced") {
  const auto none = [](std::uint32_t) { return false; };
  const auto all = [](std::uint32_t) { return true; };
  CHECK(with_letters("ä φ − ⁻³ ⁰ °", none) == "ä φ − ⁻³ ⁰ °");
  CHECK(with_letters("漢 😀", none) == "� �");
  CHECK(with_letters("漢 😀", all) == "漢 😀");
}

}  // namespace bbsim_test::test_text
