// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <sstream>

#include "catch.hpp"
#include "plot/script.hpp"

namespace bbsim_test::test_script {

using namespace bbsim::plot;
using Catch::Matchers::Contains;

namespace {

const HasLetter no_letter = [](std::uint32_t) { return false; };

Picture picture_saying(const std::string& text) {
  Picture picture;
  picture.title = text;
  return picture;
}

}  // namespace

TEST_CASE("gnuplot receives any text as plain text") {
  const std::string script =
      gnuplot_script(picture_saying("it's `id` \"$(id)\" @m ''two''\n!rm x\nset output 'y'\\"),
                     Format::svg, no_letter);
  CHECK_THAT(script, Contains("set label 'it'.apostrophe.'s `id` \"$(id)\" @m '.apostrophe.''."
                              "apostrophe.'two'.apostrophe.''.apostrophe.' !rm x set output '."
                              "apostrophe.'y'.apostrophe.'\\' at"));
  std::istringstream lines(script);
  for (std::string line; std::getline(lines, line);) {
    CHECK_FALSE(line.starts_with("!"));
    CHECK_FALSE(line.starts_with("set output"));
  }
}

TEST_CASE("letters missing from every font are kept from formats that draw letters") {
  CHECK_THAT(gnuplot_script(picture_saying("漢"), Format::svg, no_letter), Contains("'漢'"));
  CHECK_THAT(gnuplot_script(picture_saying("漢"), Format::png, no_letter), Contains("'�'"));
  CHECK_THAT(gnuplot_script(picture_saying("漢"), Format::pdf, no_letter), Contains("'�'"));
}

TEST_CASE("gaps in the data stay gaps") {
  Picture picture;
  Panel panel;
  panel.box = {0, 0, 100, 100};
  panel.x.step = panel.y.step = 1;
  panel.curves.emplace_back();
  panel.curves.back().x = {0, 1.25, 5e29};
  panel.curves.back().y = {-1e30, 1, NAN};
  picture.panels.push_back(panel);
  CHECK_THAT(gnuplot_script(picture, Format::png, no_letter),
             Contains("0 -1e+30\n1.25 1\n5e+29 NaN\n"));
  // gnuplot would draw a line across missing values.
  CHECK_THAT(gnuplot_script(picture, Format::png, no_letter), !Contains("missing"));
}

TEST_CASE("invalid XML that gnuplot leaves in a text is repaired") {
  CHECK(mended("<text>a ]]> b</text>", Format::svg) == "<text>a ]]&gt; b</text>");
  CHECK(mended("a ]]> b", Format::png) == "a ]]> b");
  CHECK(mended("<![CDATA[ x ]]>", Format::svg) == "<![CDATA[ x ]]>");
}

TEST_CASE("a picture's mark is a comment of its format") {
  CHECK(marked("<svg></svg>\n", Format::svg) == "<svg></svg>\n<!-- drawn by bbsim plot -->\n");
  CHECK(marked("%%EOF\n", Format::pdf) == "%%EOF\n% drawn by bbsim plot\n");
  // A chunk is preceded by its length and followed by a checksum, as of zlib's crc32().
  const std::string end("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
  const std::string chunk =
      std::string("\0\0\0\x1BtEXtComment\0", 16) + "drawn by bbsim plot" + "\xC0\x73\x7D\x55";
  CHECK(marked("picture" + end, Format::png) == "picture" + chunk + end);
  CHECK(marked("no picture", Format::png) == "no picture");
}

}  // namespace bbsim_test::test_script
