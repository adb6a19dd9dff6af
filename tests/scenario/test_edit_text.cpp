// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <string>

#include "base/error.hpp"
#include "catch.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/keys.hpp"

namespace bbsim_test::test_edit_text {

using namespace bbsim;

TEST_CASE("numbers change in a scenario's text, and nothing else") {
  const std::string text =
      "# mine\n"
      "ball:\n"
      "  radius: 1 cm  # a marble\n"
      "  position: [\"2 cm\", 0]\n"
      "gimbal: {motion: {phi: [{sinusoid: {amplitude: 1, frequency: 2}}, 0.5]}}\n";
  const auto with = [&](const std::string& key, const std::string& value) {
    return edited_text(text, {{key, value}});
  };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string made = text;
    return made.replace(made.find(from), from.size(), to);
  };
  CHECK(with("ball.radius", "0.02 m") == changed("1 cm", "0.02 m"));
  CHECK(with("ball.position.0", "0.03") == changed("\"2 cm\"", "0.03"));
  CHECK(with("gimbal.motion.phi.1", "0.7") == changed("0.5", "0.7"));
  CHECK(with("gimbal.motion.phi.0.sinusoid.frequency", "3") ==
        changed("frequency: 2", "frequency: 3"));
  // A new key is placed with its neighbors.
  CHECK(with("ball.mass", "2 g") == changed("# a marble\n", "# a marble\n  mass: 2 g\n"));
  CHECK(with("gimbal.motion.phi.0.sinusoid.phase", "1") ==
        changed("{amplitude", "{phase: 1, amplitude"));
  CHECK(with("ball.losses.viscous", "1e-6") ==
        changed("# a marble\n", "# a marble\n  losses: {viscous: 1e-6}\n"));
  CHECK(with("gravity", "9.8") == changed("ball:", "gravity: 9.8\nball:"));
  CHECK(edited_text(text, {{"ball.mass", "1"}, {"ball.mass", "2"}}) ==
        changed("# a marble\n", "# a marble\n  mass: 2\n"));
  CHECK_THROWS_AS(with("gimbal.motion.phi.2", "1"), InputError);
  CHECK_THROWS_AS(with("ball.radius.0", "1"), InputError);
}

TEST_CASE("a section of a scenario's text is replaced completely") {
  const std::string text =
      "ball: {radius: 1 cm, position: [\"2 cm\", 0]}  # a marble\n"
      "gimbal:\n"
      "  # tilts\n"
      "  motion:  # of a log\n"
      "    # phi is measured\n"
      "    phi:\n"
      "      - {sinusoid: {amplitude: 1, frequency: 2}}\n"
      "\n"
      "      - 0.5\n"
      "    theta: {table: {file: \"a}.csv\", time: t,  # }\n"
      "      value: 'it''s'}}\n"
      "  # the rest\n"
      "  mounting: {height: 1 cm}\n"
      "time: {end: 1, step: 1}\n";
  const auto with = [&](const std::string& key, const std::string& value) {
    return edited_text(text, {{key, value}});
  };
  CHECK(with("gimbal.motion", "{phi: 0, theta: 0}") ==
        "ball: {radius: 1 cm, position: [\"2 cm\", 0]}  # a marble\n"
        "gimbal:\n"
        "  # tilts\n"
        "  motion: {phi: 0, theta: 0}  # of a log\n"
        "  # the rest\n"
        "  mounting: {height: 1 cm}\n"
        "time: {end: 1, step: 1}\n");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string made = text;
    return made.replace(made.find(from), from.size(), to);
  };
  CHECK(with("ball.position", "[0, 0]") == changed("[\"2 cm\", 0]", "[0, 0]"));
  CHECK(with("gimbal.motion.theta", "0") ==
        changed("{table: {file: \"a}.csv\", time: t,  # }\n      value: 'it''s'}}", "0"));
  CHECK(with("gimbal.motion.phi", "0") ==
        changed("phi:\n      - {sinusoid: {amplitude: 1, frequency: 2}}\n\n      - 0.5", "phi: 0"));
  CHECK(edited_text("list:\n- 1\n- 2\nnext: 3", {{"list", "[4]"}}) == "list: [4]\nnext: 3");
  // --set KEY=null removes a section, but text edits cannot.
  CHECK_THROWS_AS(with("gimbal.motion", "null"), InputError);
  // Another key is an alias of the same section.
  for (const std::string key : {"a", "c"}) {
    CHECK_THROWS_AS(edited_text("a: &it {b: 1}\nc: *it\n", {{key, "{b: 2}"}}), InputError);
    CHECK_THROWS_AS(edited_text("a: &it {b: 1}\nc: *it\n", {{key + ".b", "2"}}), InputError);
  }
  CHECK_THROWS_AS(edited_text("a:\n  &it\n  b: 1\nc: *it\n", {{"a.b", "2"}}), InputError);
  CHECK_THROWS_AS(edited_text("a: &it 1\nc: [3, *it]\n", {{"a", "2"}}), InputError);
  CHECK_THROWS_AS(edited_text("a: &it 1\nc: [3, *it]\n", {{"c.1", "2"}}), InputError);
  CHECK(edited_text("a: &it 1\nc: [3, *it]\n", {{"c.0", "2"}}) == "a: &it 1\nc: [2, *it]\n");
  // A quote within a word is a letter; two within single quotes are one.
  CHECK(edited_text("a: {b: it's, c: ['}''', 1]}\nd: 'x'\n", {{"a.c", "[2]"}}) ==
        "a: {b: it's, c: [2]}\nd: 'x'\n");
  CHECK(edited_text("a: {b: it's}\nd: 'x'\n", {{"a", "{b: 1}"}}) == "a: {b: 1}\nd: 'x'\n");
  CHECK_THROWS_AS(edited_text("a:\n", {{"a", "{b: 2}"}}), InputError);
}

TEST_CASE("an offset in its table's unit is a number of the scenario") {
  const ScenarioFamily family(
      Source{std::string(BBSIM_SOURCE_DIR) + "/configs/scene.yaml",
             "ball: {radius: 1 cm}\n"
             "gimbal: {motion: {theta: 0, phi: {table: {file: recorded-angles.csv, time: t, value: "
             "phi, unit: deg, offset: 2}}}}\n"
             "time: {end: 1, step: 0.1}\n",
             {}});
  const auto offset = family.number_at("gimbal.motion.phi.table.offset", {});
  REQUIRE(offset);
  CHECK(*offset == Approx(0.034906585));
}

TEST_CASE("a value of a scenario as YAML in one line") {
  const ScenarioFamily family(Source{"scene.yaml",
                                     "title: \"It's flat\"\n"
                                     "ball:  # solid\n"
                                     "  radius: 1 cm\n"
                                     "gimbal: {motion: {phi: 0, theta: {table: {file: a}}}}\n"
                                     "controller:\n"
                                     "  library:\n"
                                     "    file: a, {b}.so\n",
                                     {"ball.position=[1, 2 cm]"}});
  CHECK(family.text_at("title") == "'It''s flat'");
  CHECK(family.text_at("ball") == "{radius: 1 cm, position: [1, 2 cm]}");
  CHECK(family.text_at("gimbal.motion.theta") == "{table: {file: a}}");
  CHECK(family.text_at("controller") == "{library: {file: 'a, {b}.so'}}");
  CHECK(family.text_at("ball.mass").empty());
}

TEST_CASE("the unit, range, default and meaning of a number") {
  using scenario::number_key;
  const auto factor = number_key("ball.inertia_factor");
  REQUIRE(factor);
  CHECK(factor->standard == 0.4);
  CHECK(factor->range.at_least == 0.0);
  const auto offset = number_key("gimbal.motion.phi.table.offset");
  REQUIRE(offset);
  CHECK(offset->dimension == yaml::Dimension::angle);
  CHECK(offset->standard == 0.0);
  CHECK(number_key("gimbal.motion.phi.table.scale")->standard == 1.0);
  CHECK(number_key("gimbal.motion.theta.0.table.delay")->standard == 0.0);
  CHECK(number_key("gimbal.motion.phi.0.table.delay")->dimension == yaml::Dimension::time);
  REQUIRE(number_key("controller.pd.kp.0.1"));
  CHECK(number_key("controller.pd.kp.0.1")->meaning == number_key("controller.pd.kp")->meaning);
  CHECK(number_key("ball.position.1")->meaning == "contact point (x, y) at t = 0");
  CHECK_FALSE(number_key("ball.raduis"));
  CHECK_FALSE(number_key("title"));
}

}  // namespace bbsim_test::test_edit_text
