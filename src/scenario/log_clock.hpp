// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Clocks of logs: counters that wrap, times that are doubled, unsorted or missing, epoch seconds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace bbsim::scenario {

// Adds 2^32 to what follows where a counter of 32 bits, such as millis(), has wrapped. Returns what
// was done, or nothing.
[[nodiscard]] std::optional<std::string> unwrap(std::vector<double>& times);

// The rows of a log in the order of their times (s), each time once, without rows that have none.
struct Clock {
  std::vector<std::size_t> rows;
  bool changed = false;           // they are not all rows in their order
  std::vector<std::string> done;  // what was done, in words
};
[[nodiscard]] Clock clock_of(const std::vector<double>& times);

// Whether times (s) count from an epoch and not from the start of something.
[[nodiscard]] bool counts_from_epoch(const std::vector<double>& times);

}  // namespace bbsim::scenario
