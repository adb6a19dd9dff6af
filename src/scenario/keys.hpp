// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// All keys of a scenario, as its readers declare them, and their JSON Schema.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/family.hpp"
#include "yaml/declared.hpp"

namespace bbsim::scenario {

// The declaration of the whole scenario.
[[nodiscard]] const yaml::Declared& declared_keys();

// Sorted paths of keys whose value is not a mapping, with the positions of short lists:
// ball.position, ball.position.0, ball.position.1, ... A prefix, such as
// controller.program.parameters., stands for names that the user chooses.
[[nodiscard]] std::vector<std::string> key_paths();

// What the documents say of a key, without the marks of Markdown.
[[nodiscard]] std::string plain_meaning(const yaml::About& about);

// Unit, range, default and meaning of a key that is a number.
struct NumberKey {
  yaml::Dimension dimension = yaml::Dimension::number;
  yaml::Range range{};
  std::optional<double> standard{};  // default, SI
  bool whole = false;                // without fractions
  std::string meaning{};             // of the key, or of the nearest section that says something
};

// The default as text, if any, of a key that is a single number or one of several names. Empty for
// other keys.
[[nodiscard]] std::optional<std::string> scalar_default(std::string_view path);

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

// The JSON Schema (draft-07) of the declared keys and their relations (relations.hpp), for editors
// and validators.
[[nodiscard]] std::string json_schema();

}  // namespace bbsim::scenario
