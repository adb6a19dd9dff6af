// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Single keys of a scenario's text: their places and their numbers.

#include "catch.hpp"
#include "scenario/reader.hpp"

namespace bbsim_test::test_look_up {

using bbsim::number_at;
using bbsim::place_of;
using bbsim::Source;
using bbsim::yaml::Dimension;

namespace {

const Source source{"a.yaml",
                    "ball: {radius: 2 cm}\n"
                    "controller:\n"
                    "  lqr: {position: 1}\n"
                    "  reference: {table: {file: none.csv}}\n",
                    {"controller.lqr.command=3", "ball.spin=[1, 2]"}};

}  // namespace

TEST_CASE("a key's place is its line and column, or the override that sets it") {
  CHECK(place_of(source, "controller.lqr") == "a.yaml:3:3");
  CHECK(place_of(source, "controller.lqr.position") == "a.yaml:3:9");
  CHECK(place_of(source, "controller.lqr.command") == "--set controller.lqr.command=3");
  CHECK(place_of(source, "controller.pd.kv") == "a.yaml:2:1");  // the nearest key above it
  CHECK(place_of(source, "sweep") == "a.yaml:1:1");
  CHECK(place_of({"b.yaml", "", {}}, "ball") == "b.yaml:1:1");
}

TEST_CASE("a key's number is found despite other errors in the text") {
  CHECK(number_at(source, "ball.radius", Dimension::length) == 0.02);
  CHECK(number_at(source, "controller.lqr.command", Dimension::number) == 3.0);
  CHECK_FALSE(number_at(source, "ball.radius", Dimension::time).has_value());
  CHECK_FALSE(number_at(source, "ball.spin", Dimension::angular_rate).has_value());
  CHECK_FALSE(number_at(source, "ball", Dimension::length).has_value());
  CHECK_FALSE(number_at(source, "ball.mass", Dimension::mass).has_value());
  CHECK_FALSE(number_at({"b.yaml", ": {", {}}, "ball.radius", Dimension::length).has_value());
}

}  // namespace bbsim_test::test_look_up
