// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Single keys of a scenario's text, looked up without reading the scenario.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenario/scenario.hpp"
#include "yaml/quantity.hpp"

namespace bbsim {

// Where a key stands, by its path: "file:line:column", or which override sets it. Of a key that is
// not there, where the nearest one above it stands.
[[nodiscard]] std::string place_of(const Source& source, std::string_view key);

// The number at a key, in SI units; nothing if there is none. Whatever else is wrong with the text
// does not matter, and no other file is opened.
[[nodiscard]] std::optional<double> number_at(const Source& source, std::string_view key,
                                              yaml::Dimension dimension);

}  // namespace bbsim
