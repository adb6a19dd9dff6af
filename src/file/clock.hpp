// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Clocks of logs and tables: counters that wrap; dates; repeated, unsorted or missing times; epoch
// seconds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/table.hpp"

namespace bbsim::file {

// Adds 2^32 after each wrap of a 32-bit counter such as millis(). Returns a description of the
// change, if any.
[[nodiscard]] std::optional<std::string> unwrap(std::vector<double>& times);

// The rows of a log sorted by time (s), without repeated times and rows that lack a time.
struct Clock {
  std::vector<std::size_t> rows;
  std::optional<std::size_t> restart{};  // the row in which the clock starts again; `rows` is empty
  std::vector<std::string> done;         // descriptions of the changes
};
[[nodiscard]] Clock clock_of(const std::vector<double>& times);

// Replaces dates with a time of day, or times of day, by the seconds after the first row:
// "2026-03-01 12:00:01.25", "2026-03-01T12:00:01Z", "01.03.2026 12:00:01,25", "12:00:01",
// "3/1/2026 12:00:01 PM". Times of day go on after midnight. Returns a description of the change;
// nothing if the column has no text, or a text that is neither.
[[nodiscard]] std::optional<std::string> read_stamps(Column& column);

// The unit of times without one that count from about 1970 in "ms", "us" or "ns": numbers far above
// any times in seconds. Empty for all others.
[[nodiscard]] std::string_view unit_since_epoch(const std::vector<double>& times);

// Whether times (s) count from an epoch, such as 1970.
[[nodiscard]] bool counts_from_epoch(const std::vector<double>& times);

}  // namespace bbsim::file
