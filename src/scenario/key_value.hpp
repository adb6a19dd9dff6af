// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is known of a key that is a number: its unit, its range and its default.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "yaml/declared.hpp"

namespace bbsim::scenario {

struct NumberKey {
  yaml::Dimension dimension = yaml::Dimension::number;
  yaml::Range range{};
  std::optional<double> standard{};  // if nothing is given, SI
};

// Nothing for a key that no scenario has, or that takes no number.
[[nodiscard]] std::optional<NumberKey> number_key(std::string_view path);

}  // namespace bbsim::scenario
