// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Statistics of a sweep's cases by group, for noise or draws that repeat a case.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/table.hpp"

namespace bbsim::record {

// Statistics of one measure's finite values over the cases of a group that ran to their end.
struct GroupFigures {
  std::string measure;
  std::size_t count = 0;
  // The deviation is the sample's, over count - 1; NaN for fewer than two values. All others are
  // NaN if there is no value.
  double mean = 0, deviation = 0, least = 0, greatest = 0;
  std::vector<double> quantiles;  // interpolated linearly between two values, as in numpy
};

struct Group {
  std::vector<std::string> values;  // values of the keys that define the group
  std::size_t cases = 0;            // all cases, however they ended
  std::vector<GroupFigures> figures;
};

// Groups appear in the order of their first case; without keys, all cases form one. If `measures`
// is empty, all numeric columns after the status, if any, are used. Throws InputError if the table,
// named `name`, lacks a column or has texts instead of numbers.
[[nodiscard]] std::vector<Group> summarise(const file::Table& table, const std::string& name,
                                           const std::vector<std::string>& keys,
                                           const std::vector<std::string>& measures,
                                           const std::vector<double>& quantiles);

// CSV with the keys, measure, cases, count, mean, deviation, min, a column per quantile (q5, q50,
// ...) and max.
[[nodiscard]] std::string to_csv(const std::vector<Group>& groups,
                                 const std::vector<std::string>& keys,
                                 const std::vector<double>& quantiles);

}  // namespace bbsim::record
