// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows of a sweep: as CSV text, as a block of columns, and counted by their status.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace bbsim::file {
struct Hdf5Block;
}

namespace bbsim::sweep {

struct SweepTask;
struct CaseResults;

// A case that ended early, or that misses an expectation.
struct FailedCase {
  std::size_t number = 0;
  std::string status, reason;
};

// How many cases ended with each status, and how many miss each expectation.
struct StatusCounts {
  std::map<std::string, std::size_t, std::less<>> words;  // by status
  std::size_t not_finite = 0;      // status done with a reason: a measure is not finite
  std::vector<std::size_t> unmet;  // by expectation
  std::vector<FailedCase> failed;  // the first most_failed of them

  static constexpr std::size_t most_failed = 20;

  // In the order of the cases.
  void add(const SweepTask& task, const CaseResults& results);
  [[nodiscard]] std::size_t early() const;  // cases that ended before their end time
};

// Writes the rows as CSV into the results' text: all columns but the series.
void write_rows(const SweepTask& task, CaseResults& results);

// Appends the same rows, and the series, to a block.
void append_rows(const SweepTask& task, const CaseResults& results, file::Hdf5Block& block);

}  // namespace bbsim::sweep
