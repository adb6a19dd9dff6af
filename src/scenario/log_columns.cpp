// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/log_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "scenario/columns.hpp"

namespace bbsim::scenario {
namespace {

struct Word {
  std::string_view word, unit;
};
constexpr std::array words = {Word{"degrees", "deg"}, Word{"degree", "deg"}, Word{"radians", "rad"},
                              Word{"seconds", "s"},   Word{"sec", "s"},      Word{"msec", "ms"},
                              Word{"millis", "ms"},   Word{"usec", "us"},    Word{"micros", "us"},
                              Word{"meters", "m"}};

struct Parts {
  std::string_view bare, unit;
};

Parts parts_of(std::string_view name) {
  for (const std::string_view brackets : {"[]", "()"}) {
    const std::size_t open = name.rfind(brackets[0]);
    if (open == std::string_view::npos || open == 0 || name.back() != brackets[1]) continue;
    return {trimmed(name.substr(0, open)), trimmed(name.substr(open + 1, name.size() - open - 2))};
  }
  const std::size_t line = name.rfind('_');
  if (line == std::string_view::npos || line == 0) return {name, {}};
  return {name.substr(0, line), name.substr(line + 1)};
}

constexpr double most_rad = 1.6, most_m = 1, most_runs = 10;

}  // namespace

std::optional<yaml::UnitScale> log_unit(std::string_view unit, yaml::Dimension dimension) {
  const auto* const word = std::ranges::find(words, unit, &Word::word);
  return yaml::unit_scale(word == words.end() ? unit : word->unit, dimension);
}

std::optional<yaml::UnitScale> unit_in_name(std::string_view name, yaml::Dimension dimension) {
  const Parts parts = parts_of(name);
  if (parts.unit.empty()) return {};
  return log_unit(parts.unit, dimension);
}

std::optional<std::size_t> find_log_column(const std::vector<std::string>& names,
                                           std::string_view wanted, yaml::Dimension dimension) {
  const auto exact = std::ranges::find(names, wanted);
  if (exact != names.end()) return static_cast<std::size_t>(exact - names.begin());
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (parts_of(names[c]).bare == wanted && unit_in_name(names[c], dimension)) return c;
  }
  return {};
}

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
