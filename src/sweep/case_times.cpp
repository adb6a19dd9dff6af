// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/case_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/instant.hpp"

namespace bbsim::sweep {

bool is_same_time(double time, double bound) {
  return std::abs(time - bound) <= rounding_of(std::max(std::abs(time), std::abs(bound)));
}

TimedRows rows_at(std::span<const double> times, double begin, double end) {
  std::vector<double> rows{0};
  std::size_t i = 0;
  while (i < times.size() && times[i] < begin && !is_same_time(times[i], begin)) ++i;
  std::vector<std::size_t> first{i};
  for (; i < times.size() && (times[i] <= end || is_same_time(times[i], end)); ++i) {
    const double t = is_same_time(times[i], begin) ? 0
                     : is_same_time(times[i], end) ? end - begin
                                                   : times[i] - begin;
    if (!(t > rows.back())) continue;
    rows.push_back(t);
    first.push_back(i);
  }
  if (end - begin > rows.back()) {
    rows.push_back(end - begin);
    first.push_back(i);
  }
  first.push_back(i);
  return {solve::OutputGrid(std::move(rows)), std::move(first)};
}

void SeriesWriter::append(std::span<const double* const> columns, std::size_t rows) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double* const into = series_[c].data() + place_;
    if (timed_ == nullptr) {
      std::copy_n(columns[c], rows, into + row_);
      continue;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      const auto& first = timed_->first;
      std::fill(into + first[row_ + r], into + first[row_ + r + 1], columns[c][r]);
    }
  }
  row_ += rows;
}

}  // namespace bbsim::sweep
