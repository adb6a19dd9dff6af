// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Clocks of logs: counters that wrap; repeated, unsorted or missing times; epoch seconds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace bbsim::scenario {

// Adds 2^32 after each wrap of a 32-bit counter such as millis(). Returns a description of the
// change, if any.
[[nodiscard]] std::optional<std::string> unwrap(std::vector<double>& times);

// The rows of a log sorted by time (s), without repeated times and rows that lack a time.
struct Clock {
  std::vector<std::size_t> rows;
  bool changed = false;           // rows were dropped or moved
  std::vector<std::string> done;  // descriptions of the changes
};
[[nodiscard]] Clock clock_of(const std::vector<double>& times);

// Whether times (s) count from an epoch, such as 1970.
[[nodiscard]] bool counts_from_epoch(const std::vector<double>& times);

}  // namespace bbsim::scenario
