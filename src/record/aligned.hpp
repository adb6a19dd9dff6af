// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables in reports: aligned columns of short numbers.
#pragma once

#include <string>
#include <vector>

namespace bbsim::record {

// Three digits suffice to judge an error.
[[nodiscard]] std::string rounded(double value);

// For a table's column of units: a number without one has the unit 1.
[[nodiscard]] std::string unit_or_one(const std::string& unit);

// Lines of as many fields each: the first one to the left, the others to the right.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& lines);

}  // namespace bbsim::record
