// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Statistics of a sweep's cases by group, for noise or draws that repeat a case.
#pragma once

#include <string>
#include <vector>

#include "file/table.hpp"

namespace bbsim::record {

// CSV: a row for each group and measure, with the keys, measure, cases, count, mean, deviation,
// min, a column per quantile (q5, q50, ...) and max. `cases` are all cases of the group; the
// statistics are those of finite values in cases that ran to their end. The deviation is the
// sample's, over count - 1; quantiles are interpolated linearly, as in numpy; what needs more
// values is NaN.
//
// Groups appear in the order of their first case; without keys, all cases form one. If `measures`
// is empty, all numeric columns after the status, if any, are used. Throws InputError if the table,
// named `name`, lacks a column or has texts instead of numbers.
[[nodiscard]] std::string summarise(const file::Table& table, const std::string& name,
                                    const std::vector<std::string>& keys,
                                    const std::vector<std::string>& measures,
                                    const std::vector<double>& quantiles);

}  // namespace bbsim::record
