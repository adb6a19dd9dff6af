// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers of a table or a log that look as if they were not in SI units and radians.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "yaml/quantity.hpp"

namespace bbsim::scenario {

struct Doubt {
  std::string_view looks_like;  // "degrees"
  std::string_view units;       // that say so: "deg"
};

// Of angles, which rarely exceed 1.6 rad, and of lengths, which rarely exceed 1 m, on a plate.
[[nodiscard]] std::optional<Doubt> doubt_of(double largest, yaml::Dimension dimension);
// The same of a column that has the name of one of `bbsim columns`; a ball may turn as far as it
// likes.
[[nodiscard]] std::optional<Doubt> doubt_of(double largest, std::string_view column);
// The largest finite size among the numbers; 0 of none.
[[nodiscard]] double largest_size(const std::vector<double>& numbers);

// Of times that span more than ten times the run.
[[nodiscard]] std::optional<Doubt> doubt_of_span(double span, double run);

}  // namespace bbsim::scenario
