// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows of a case at times of the user's.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "file/table_writer.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::sweep {

// Times of the columns, by the scenario's clock: one list for all cases, or one for each.
struct CaseTimes {
  std::vector<double> values{};  // s; lists that do not decrease, one after the other
  std::size_t count = 0;         // in a list
  bool each = false;

  [[nodiscard]] std::span<const double> of(std::size_t number) const {
    return std::span(values).subspan(each ? number * count : 0, count);
  }
};

// The output rows of a run at some times: the start, each time once, and the end.
struct TimedRows {
  solve::OutputGrid grid;
  // Row r is at the times first[r] to first[r + 1] - 1 of the list. Times outside of the run have
  // no row.
  std::vector<std::size_t> first;
};

// `times` do not decrease. The run covers `begin` to `end` (s); its own clock starts at 0.
[[nodiscard]] TimedRows rows_at(std::span<const double> times, double begin, double end);

// Whether `time` is `bound`, or differs from it by rounding.
[[nodiscard]] bool is_same_time(double time, double bound);

// Writes a case's columns to its place in the series.
class SeriesWriter : public file::TableWriter {
 public:
  // `timed` tells the times of the rows; null: each row has one.
  SeriesWriter(std::vector<std::vector<double>>& series, std::size_t place, const TimedRows* timed)
      : series_(series), place_(place), timed_(timed) {}

  void append(std::span<const double* const> columns, std::size_t rows) override;
  void finish(const file::Attributes&) override {}

 private:
  std::vector<std::vector<double>>& series_;
  std::size_t place_;
  const TimedRows* timed_;
  std::size_t row_ = 0;
};

}  // namespace bbsim::sweep
