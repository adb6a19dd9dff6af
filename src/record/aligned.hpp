// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables in reports: aligned columns of short numbers.
#pragma once

#include <string>
#include <vector>

namespace bbsim::record {

// Rounds to three digits, which suffice to judge an error.
[[nodiscard]] std::string rounded(double value);

// Aligns lines of equal length: the first field to the left, the others to the right.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& lines);

}  // namespace bbsim::record
