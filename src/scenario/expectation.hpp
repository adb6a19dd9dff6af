// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An expected bound on a measure: "max_tilt < 5 deg".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/measures.hpp"

namespace bbsim::scenario {

struct Expectation {
  std::string text;  // as given
  Measure measure{};
  double value = 0;                        // in the measure's unit
  bool is_upper = true, or_equal = false;  // < or <=, else > or >=; <= or >=

  // False for NaN.
  [[nodiscard]] bool holds(double measured) const {
    if (measured == value) return or_equal;
    return is_upper ? measured < value : measured > value;
  }
};

// Reads "MEASURE < VALUE", or with <=, > or >=. The value may have a unit. Throws InputError,
// starting with `where`, if the text is invalid or the scene lacks the measure.
[[nodiscard]] Expectation read_expectation(std::string_view where, std::string_view text,
                                           const Scenario& scenario);

// Appends the measures of expectations that `measures` lack. Returns the place of each one's.
std::vector<std::size_t> add_expected(std::vector<Measure>& measures,
                                      const std::vector<Expectation>& expectations);

}  // namespace bbsim::scenario
