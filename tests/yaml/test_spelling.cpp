// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "yaml/spelling.hpp"

namespace bbsim_test::test_spelling {

using bbsim::yaml::american;
using bbsim::yaml::british;
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

}  // namespace bbsim_test::test_spelling
