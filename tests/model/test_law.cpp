// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The list of a law's numbers, which lanes and derivatives by keys use.
#include <cstddef>

#include "catch.hpp"
#include "model/control/law.hpp"

namespace bbsim_test::test_law {

using bbsim::model::ControlLaw;
using bbsim::model::for_each_number;

TEST_CASE("the list of a law's numbers has each of them once") {
  ControlLaw law, other;
  double count = 0;
  for_each_number(law, law, [&count](double& number, double&) { number = ++count; });
  // The law's kind takes the space of one more number.
  CHECK(static_cast<std::size_t>(count + 1) * sizeof(double) == sizeof(ControlLaw));

  for_each_number(other, law, [](double& to, const double& from) { to = from; });
  double expected = 0;
  for_each_number(other, other,
                  [&expected](double& number, double&) { CHECK(number == ++expected); });
}

}  // namespace bbsim_test::test_law
