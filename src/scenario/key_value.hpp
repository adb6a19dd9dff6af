// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Unit, range and default of a key that is a number.
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
  std::optional<double> standard{};  // default, SI
  bool whole = false;                // without fractions
};

// A key that is a single number or one of several names.
struct ScalarKey {
  yaml::Dimension dimension = yaml::Dimension::number;  // of a number
  std::string standard{};                               // default as text, if any
};

// Empty for an unknown key and for a key that takes neither.
[[nodiscard]] std::optional<ScalarKey> scalar_key(std::string_view path);

// Empty for an unknown key and for a key that takes no number.
[[nodiscard]] std::optional<NumberKey> number_key(std::string_view path);

// A key of a scenario that an option names.
struct NamedNumber {
  std::string name;
  NumberKey key;
  std::string unit{};             // SI; empty for a number
  std::optional<double> value{};  // from the scenario, or else the default, SI

  [[nodiscard]] ScenarioFamily::Setting setting(double to) const;
};

// Throws InputError, starting with the option, for a key that takes no single number.
[[nodiscard]] NamedNumber number_named(const std::string& option, std::string name,
                                       const ScenarioFamily& family);

}  // namespace bbsim::scenario
