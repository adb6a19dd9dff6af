// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/expectation.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {

Expectation read_expectation(std::string_view where, std::string_view text,
                             const Scenario& scenario) {
  text = trimmed(text);
  const std::string found = std::string(where) + ": found " + bbsim::quoted(std::string(text));
  // Names of measures contain neither sign.
  const std::size_t sign = text.find_first_of("<>");
  if (sign == std::string_view::npos) {
    throw InputError(found +
                     "; allowed: \"MEASURE < VALUE\", or with <=, > or >=, such as \"max_tilt < 5 "
                     "deg\"");
  }
  Expectation expectation;
  expectation.is_upper = text[sign] == '<';
  expectation.or_equal = sign + 1 < text.size() && text[sign + 1] == '=';
  expectation.text = text;
  expectation.measure = measure_named(where, std::string(trimmed(text.substr(0, sign))), scenario);
  const std::string unit = expectation.measure.unit();
  const auto value = yaml::value_in(text.substr(sign + (expectation.or_equal ? 2 : 1)), unit);
  if (!value) {
    throw InputError(found + ", but " + expectation.measure.name + " is in " + unit +
                     "; allowed: a number in that unit, or a quantity of its kind");
  }
  expectation.value = *value;
  return expectation;
}

std::vector<std::size_t> add_expected(std::vector<Measure>& measures,
                                      const std::vector<Expectation>& expectations) {
  std::vector<std::size_t> places;
  for (const Expectation& expectation : expectations) {
    const auto found = std::ranges::find(measures, expectation.measure.name, &Measure::name);
    places.push_back(static_cast<std::size_t>(found - measures.begin()));
    if (found == measures.end()) measures.push_back(expectation.measure);
  }
  return places;
}

}  // namespace bbsim::scenario
