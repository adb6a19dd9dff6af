// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/value_in.hpp"

#include <cmath>

#include "base/text.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {

std::optional<double> value_in(std::string_view text, std::string_view unit) {
  text = trimmed(text);
  const yaml::Dimension dimension = yaml::dimension_of(unit);
  if (dimension == yaml::Dimension::number && unit != "1" && text.ends_with(unit)) {
    text = trimmed(text.substr(0, text.size() - unit.size()));
  }
  const std::optional<double> value = yaml::read_quantity(text, false, dimension).value;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace bbsim::scenario
