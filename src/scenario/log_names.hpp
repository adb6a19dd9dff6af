// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names of a log's columns that carry a unit: "x [mm]", "x (mm)", "tilt_deg", "timestamp_ms".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "yaml/quantity.hpp"

namespace bbsim::scenario {

// The unit of the dimension in a column's name, if there is one.
[[nodiscard]] std::optional<yaml::UnitScale> unit_in_name(std::string_view name,
                                                          yaml::Dimension dimension);

// A unit of the dimension by its name or by a word such as "degrees".
[[nodiscard]] std::optional<yaml::UnitScale> log_unit(std::string_view unit,
                                                      yaml::Dimension dimension);

// The index in `names` of the column `wanted`, with or without a unit of the dimension. Empty if
// there is none.
[[nodiscard]] std::optional<std::size_t> find_log_column(const std::vector<std::string>& names,
                                                         std::string_view wanted,
                                                         yaml::Dimension dimension);

}  // namespace bbsim::scenario
