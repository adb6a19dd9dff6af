// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Recognizes numbers of a table or a log that do not look like SI units and radians.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "yaml/quantity.hpp"

namespace bbsim::scenario {

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
