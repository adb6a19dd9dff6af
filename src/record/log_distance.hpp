// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How far the log of a rig is from a run of bbsim, and the time offset between their clocks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/table.hpp"

namespace bbsim::record {

struct ColumnDistance {
  std::string name;
  double rms = 0;
  double greatest = 0, at = 0;  // |log - run| and its time, s
  double log = 0, run = 0;      // the values there
  std::size_t rows = 0;         // compared rows
};

struct LogDistance {
  std::vector<ColumnDistance> columns;
  double from = 0, to = 0;                // the times in common, s
  std::size_t rows = 0, rows_of_log = 0;  // in common; of the log
};

// The distance at the log's rows. Between its rows, the run is a cubic if it has the slope (vx, vy,
// phi_rate, theta_rate), and a straight line otherwise. Both tables need a column t with increasing
// times. `columns` selects some; if it is empty, all columns in common are compared. Both
// are columns of numbers. Throws InputError.
[[nodiscard]] LogDistance log_distance(const file::Table& log, const file::Table& run,
                                       const std::vector<std::string>& columns = {});

// Returns the time (s) that, added to the log's times, makes it most like the run, over all columns
// in common and at least half of the shorter one. Throws InputError if nothing in common varies.
[[nodiscard]] double time_offset(const file::Table& log, const file::Table& run,
                                 const std::vector<std::string>& columns = {});

// A table of the columns, then the time in common.
[[nodiscard]] std::string to_text(const LogDistance& distance, const std::string& log_name,
                                  const std::string& run_name);

}  // namespace bbsim::record
