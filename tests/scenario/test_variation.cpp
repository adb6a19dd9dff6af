// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// SPEC of a sweep, as a user writes it.
#include <string>

#include "base/error.hpp"
#include "catch.hpp"
#include "scenario/variation.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_variation {

using namespace bbsim;
using namespace bbsim::scenario;
using Kind = VariationSpec::Kind;

namespace {

VariationSpec read(const std::string& spec) {
  return parse_variation({"ball.radius", spec});
}

std::string fault(const std::string& spec) {
  return message_of<InputError>([&] { static_cast<void>(read(spec)); });
}

}  // namespace

TEST_CASE("specs are read") {
  const VariationSpec linear = read("linear:-10 cm: 0.1 :21");
  CHECK(linear.kind == Kind::linear);
  CHECK(linear.values == std::vector<std::string>{"-10 cm", "0.1"});
  CHECK(linear.count == 21);
  CHECK_FALSE(linear.random());
  CHECK(read("log:1e-3:10:5").kind == Kind::log);
  CHECK(read("uniform:0:1").random());
  CHECK(read("normal:1 cm:1 mm").values == std::vector<std::string>{"1 cm", "1 mm"});
}

TEST_CASE("commas inside a value do not split a list") {
  const VariationSpec list = read("list:[[1, 0], [0, -1]], 2, \"a, b\", {c: [3, 4]}");
  CHECK(list.values ==
        std::vector<std::string>{"[[1, 0], [0, -1]]", "2", "\"a, b\"", "{c: [3, 4]}"});
  CHECK(list.count == 4);
  CHECK(read("list:5").values == std::vector<std::string>{"5"});
}

TEST_CASE("an invalid spec is refused with its key and what is allowed, before any case is read") {
  struct Wrong {
    std::vector<std::string> specs;
    std::string allowed;
  };
  const auto [specs, allowed] = GENERATE(values<Wrong>({
      {{"", "1:2:3", "linear:1:2", "linear:1:2:3:4", "linear", "uniform:1", "normal:1:2:3",
        "list:", "list:1,,2", "linear::2:3", "quadratic:1:2:3"},
       "linear:FROM:TO:COUNT"},
      {{"linear:0:1:0", "linear:0:1:-3", "linear:0:1:2.5", "linear:0:1:1e99"},
       "a whole number from 1 to 1e9"},
      {{"linear:null:1:3", "linear:0.01:~:3", "log:*a:1:3", "linear:{}:1:3", "uniform:a:b",
        "normal:0:true"},
       "numbers and quantities"},
  }));
  for (const std::string& spec : specs) {
    INFO(spec);
    CHECK(fault(spec).find("ball.radius: found ") == 0);
    CHECK(fault(spec).find(allowed) != std::string::npos);
  }
  for (const char* right : {"linear:\"1 cm\":'2 cm':3", "log:.5:1:3", "uniform:-1e-3:+2"}) {
    INFO(right);
    CHECK(fault(right).empty());
  }
}

TEST_CASE("KEY=SPEC is split at its first equals sign") {
  const Variation variation = split_variation("a.b=list:x=1");
  CHECK(variation.key == "a.b");
  CHECK(variation.spec == "list:x=1");
  CHECK_THROWS_AS(split_variation("a.b"), InputError);
  CHECK_THROWS_AS(split_variation("=list:1"), InputError);
}

TEST_CASE("a scenario may have a sweep") {
  const Scenario scene =
      test::parse(test::open_loop +
                  "sweep:\n"
                  "  vary: {ball.radius: 'linear:0.01:0.02:3', gravity: 'list:1,2'}\n"
                  "  combine: zip\n"
                  "  samples: 5\n"
                  "  seed: 7\n"
                  "  measure: [max_x, end_phi]\n");
  REQUIRE(scene.sweep.vary.size() == 2);
  CHECK(scene.sweep.vary[1].key == "gravity");
  CHECK(scene.sweep.vary[1].spec == "list:1,2");
  CHECK(scene.sweep.combine == Combine::zip);
  CHECK(scene.sweep.samples == 5);
  CHECK(scene.sweep.seed == 7);
  CHECK(scene.sweep.measure == std::vector<std::string>{"max_x", "end_phi"});
}

}  // namespace bbsim_test::test_variation
