// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>

#include "catch.hpp"
#include "yaml/spelling.hpp"

namespace bbsim_test::test_nearest {

using bbsim::yaml::nearest_name;

TEST_CASE("the nearest name has the fewest typing errors") {
  constexpr std::array<std::string_view, 5> names = {"radius", "mass", "position", "velocity",
                                                     "frequency"};
  CHECK(nearest_name("raduis", names) == "radius");   // two letters swapped
  CHECK(nearest_name("radus", names) == "radius");    // one missing
  CHECK(nearest_name("radiuss", names) == "radius");  // one added
  CHECK(nearest_name("Mass", names) == "mass");
  CHECK(nearest_name("MASS", names) == "mass");
  CHECK(nearest_name("poistion", names) == "position");
  CHECK(nearest_name("freq", names) == "frequency");  // an abbreviation
  CHECK(nearest_name("colour", names).empty());
  CHECK(nearest_name("", names).empty());
  CHECK(nearest_name(std::string(1000, 'r'), names).empty());
  CHECK(nearest_name("radius", {}).empty());
}

}  // namespace bbsim_test::test_nearest
