// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a sweep's cases come to, group by group: where noise or draws make many of one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/cell_table.hpp"

namespace bbsim::record {

// Of the finite values of one measure over the cases of a group that came to their end.
struct GroupFigures {
  std::string measure;
  std::size_t count = 0;
  // Deviation: the sample's, over count - 1; no number of fewer than two values. All others are
  // none where there is no value.
  double mean = 0, deviation = 0, least = 0, greatest = 0;
  std::vector<double> quantiles;  // between two values on the straight line, as numpy has them
};

struct Group {
  std::vector<std::string> values;  // of the keys that the groups are by
  std::size_t cases = 0;            // all of them, however they ended
  std::vector<GroupFigures> figures;
};

// Groups in the order in which they first appear. Without keys all cases are one. `measures` empty:
// all columns of numbers that come after the status. Throws InputError for a column that the
// table, of that name, does not have, or that has texts where numbers are wanted.
[[nodiscard]] std::vector<Group> summarise(const file::CellTable& table, const std::string& name,
                                           const std::vector<std::string>& keys,
                                           const std::vector<std::string>& measures,
                                           const std::vector<double>& quantiles);

// CSV: the keys; measure, cases, count, mean, deviation, min, a column q5, q50, ... a quantile,
// max.
[[nodiscard]] std::string to_csv(const std::vector<Group>& groups,
                                 const std::vector<std::string>& keys,
                                 const std::vector<double>& quantiles);

}  // namespace bbsim::record
