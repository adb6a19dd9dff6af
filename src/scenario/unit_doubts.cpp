// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/unit_doubts.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/columns.hpp"

namespace bbsim::scenario {
namespace {

constexpr double most_rad = 1.6, most_m = 1, most_runs = 10;

}  // namespace

std::optional<Doubt> doubt_of(double largest, yaml::Dimension dimension) {
  if (dimension == yaml::Dimension::angle && largest > most_rad) return Doubt{"degrees", "deg"};
  if (dimension == yaml::Dimension::length && largest > most_m) {
    return Doubt{"millimeters or centimeters", "mm or cm"};
  }
  return {};
}

std::optional<Doubt> doubt_of(double largest, std::string_view column) {
  const auto* const known = std::ranges::find(catalogue, column, &Column::name);
  if (known == catalogue.end() || known->needs == Needs::gamma) return {};
  return doubt_of(largest, yaml::dimension_of(known->unit));
}

double largest_size(const std::vector<double>& numbers) {
  double largest = 0;
  for (const double number : numbers) {
    if (std::isfinite(number)) largest = std::max(largest, std::abs(number));
  }
  return largest;
}

std::optional<Doubt> doubt_of_span(double span, double run) {
  if (span > most_runs * run) return Doubt{"milliseconds", "ms"};
  return {};
}

}  // namespace bbsim::scenario
