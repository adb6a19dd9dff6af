// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Nesting limit of JSON from outside.
#include <nlohmann/json.hpp>
#include <string>

#include "base/json.hpp"
#include "catch.hpp"

namespace bbsim_test::test_json {

using namespace bbsim;

namespace {

std::string nested(std::size_t depth) {
  return std::string(depth, '[') + std::string(depth, ']');
}

}  // namespace

TEST_CASE("JSON is read up to its nesting limit and no deeper") {
  CHECK(parse_json(nested(deepest_json)).is_array());
  CHECK(parse_json(nested(deepest_json + 1)).is_discarded());
  CHECK(parse_json(nested(10'000'000)).is_discarded());
  std::string mappings, ends;
  for (std::size_t i = 0; i < deepest_json; ++i) {
    mappings += "{\"a\": ";
    ends += "}";
  }
  CHECK(parse_json(mappings + "1" + ends).is_object());
  CHECK(parse_json("[" + mappings + "1" + ends + "]").is_discarded());
  CHECK(parse_json("[1").is_discarded());
  CHECK(parse_json("").is_discarded());
}

TEST_CASE("brackets in strings do not count") {
  const std::string brackets(1000, '[');
  CHECK(parse_json("[\"" + brackets + "\", {\"" + brackets + "\": 1}]").size() == 2);
  CHECK(parse_json("[\"\\\"" + brackets + "\"]").front() == "\"" + brackets);
  CHECK(parse_json("[\"\\\\\", " + nested(deepest_json) + "]").is_discarded());
  CHECK(parse_json("[\"\\\\\", " + nested(deepest_json - 1) + "]").size() == 2);
}

}  // namespace bbsim_test::test_json
