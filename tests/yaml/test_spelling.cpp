// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>

#include "catch.hpp"
#include "yaml/spelling.hpp"

namespace bbsim_test::test_spelling {

using bbsim::yaml::american;
using bbsim::yaml::british;
using bbsim::yaml::nearest_name;
using bbsim::yaml::other_spelling;

TEST_CASE("keys have an American and a British spelling") {
  CHECK(american("plate.centre_of_mass") == "plate.center_of_mass");
  CHECK(american("controller.feedback_linearisation.kv.0.1") ==
        "controller.feedback_linearization.kv.0.1");
  CHECK(british("controller.reference.circle.center.0") == "controller.reference.circle.centre.0");
  CHECK(british(american("centre.centre_of_mass")) == "centre.centre_of_mass");
  CHECK(american("ball.radius") == "ball.radius");
}

TEST_CASE("only whole words have two spellings") {
  CHECK(american("centres.epicentre.centre") == "centres.epicentre.center");
  CHECK(british("recenter_center") == "recenter_centre");
  CHECK(american("").empty());
}

TEST_CASE("the other spelling of a name is returned if it exists") {
  CHECK(other_spelling("center") == "centre");
  CHECK(other_spelling("centre") == "center");
  CHECK(other_spelling("feedback_linearization") == "feedback_linearisation");
  CHECK_FALSE(other_spelling("radius"));
}

TEST_CASE("the nearest name has the fewest typing errors") {
  constexpr std::array<std::string_view, 5> names = {"radius", "mass", "position", "velocity",
                                                     "frequency"};
  // Two letters swapped, one missing, one added.
  for (const char* wrong : {"raduis", "radus", "radiuss"}) {
    CHECK(nearest_name(wrong, names) == "radius");
  }
  // Two swapped letters are one error.
  constexpr std::array<std::string_view, 2> close = {"velociaa", "velocity"};
  CHECK(nearest_name("velociyt", close) == "velocity");
  CHECK(nearest_name("Mass", names) == "mass");
  CHECK(nearest_name("MASS", names) == "mass");
  CHECK(nearest_name("poistion", names) == "position");
  CHECK(nearest_name("freq", names) == "frequency");  // an abbreviation
  CHECK(nearest_name("colour", names).empty());
  CHECK(nearest_name("", names).empty());
  CHECK(nearest_name(std::string(1000, 'r'), names).empty());
  CHECK(nearest_name("radius", {}).empty());
}

}  // namespace bbsim_test::test_spelling
