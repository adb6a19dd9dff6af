// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Columns of logs and tables: names that carry a unit, and numbers that do not look like SI units
// and radians.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "yaml/quantity.hpp"

namespace bbsim::scenario {

// Names that carry a unit: "x [mm]", "x (mm)", "tilt_deg", "timestamp_ms".
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

// Numbers that do not look like SI units and radians.
struct Doubt {
  std::string_view looks_like;  // "degrees"
  std::string_view units;       // that explain the numbers: "deg"
};

// Doubts angles above 1.6 rad and lengths above 1 m, which are rare on a plate.
[[nodiscard]] std::optional<Doubt> doubt_of(double largest, yaml::Dimension dimension);
// The same for a column of `bbsim columns`. Does not doubt gamma, which has no limit.
[[nodiscard]] std::optional<Doubt> doubt_of(double largest, std::string_view column);
// The largest absolute value of the finite numbers; 0 if there are none.
[[nodiscard]] double largest_size(const std::vector<double>& numbers);

// Doubts times that span more than ten times the run.
[[nodiscard]] std::optional<Doubt> doubt_of_span(double span, double run);

}  // namespace bbsim::scenario
