// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is known of a key that is a number: its unit, its range and its default.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenario/family.hpp"
#include "yaml/declared.hpp"

namespace bbsim::scenario {

struct NumberKey {
  yaml::Dimension dimension = yaml::Dimension::number;
  yaml::Range range{};
  std::optional<double> standard{};  // if nothing is given, SI
};

// Nothing for a key that no scenario has, or that takes no number.
[[nodiscard]] std::optional<NumberKey> number_key(std::string_view path);

// A key of a scenario that an option names.
struct NamedNumber {
  std::string name;
  NumberKey key;
  std::string unit{};             // SI; empty for a number
  std::optional<double> value{};  // the scenario's, or its default, SI

  [[nodiscard]] ScenarioFamily::Setting setting(double to) const;
};

// Throws InputError, which begins with the option, for a key that takes no single number.
[[nodiscard]] NamedNumber number_named(const std::string& option, std::string name,
                                       const ScenarioFamily& family);

}  // namespace bbsim::scenario
