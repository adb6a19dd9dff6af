// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Looks up single keys in a scenario's text without reading the whole scenario.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenario/scenario.hpp"
#include "yaml/quantity.hpp"

namespace bbsim {

// The place of the key: "file:line:column", or the override that sets it. For a missing key, the
// place of the nearest key above it.
[[nodiscard]] std::string place_of(const Source& source, std::string_view key);

// The number at the key in SI units, or nothing. Ignores all other problems of the text and opens
// no other files.
[[nodiscard]] std::optional<double> number_at(const Source& source, std::string_view key,
                                              yaml::Dimension dimension);

}  // namespace bbsim
