// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Columns of logs and tables: names that carry a unit, numbers that do not look like SI units and
// radians, and clocks.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/table.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {

// Names that carry a unit: "x [mm]", "x (mm)", "tilt_deg", "timestamp_ms".
// The unit of the dimension in a column's name, if there is one.
[[nodiscard]] std::optional<yaml::UnitScale> unit_in_name(std::string_view name,
                                                          yaml::Dimension dimension);

// A unit of the dimension by its name or by a word such as "degrees".
[[nodiscard]] std::optional<yaml::UnitScale> log_unit(std::string_view unit,
                                                      yaml::Dimension dimension);

// The index in `names` of the column `wanted`, with or without a unit of the dimension. Empty if
// there is none.
[[nodiscard]] std::optional<std::size_t> find_log_column(const std::vector<std::string>& names,
                                                         std::string_view wanted,
                                                         yaml::Dimension dimension);

// Numbers that do not look like SI units and radians.
struct Doubt {
  std::string_view looks_like;  // "degrees"
  std::string_view units;       // that explain the numbers: "deg"
};

// Doubts angles above 1.6 rad and lengths above 1 m, which are rare on a plate.
[[nodiscard]] std::optional<Doubt> doubt_of(double largest, yaml::Dimension dimension);
// The same for a column of `bbsim columns`. Does not doubt gamma, which has no limit.
[[nodiscard]] std::optional<Doubt> doubt_of(double largest, std::string_view column);
// The largest absolute value of the finite numbers; 0 if there are none.
[[nodiscard]] double largest_size(const std::vector<double>& numbers);

// Doubts times that span more than ten times the run.
[[nodiscard]] std::optional<Doubt> doubt_of_span(double span, double run);

// Clocks: counters that wrap; repeated, unsorted or missing times; epoch seconds.
// Adds 2^32 after each wrap of a 32-bit counter such as millis(). Returns a description of the
// change, if any.
[[nodiscard]] std::optional<std::string> unwrap(std::vector<double>& times);

// The rows of a log sorted by time (s), without repeated times and rows that lack a time.
struct Clock {
  std::vector<std::size_t> rows;
  std::optional<std::size_t> restart{};  // the row in which the clock starts again; `rows` is empty
  bool changed = false;                  // rows were dropped or moved
  std::vector<std::string> done;         // descriptions of the changes
};
[[nodiscard]] Clock clock_of(const std::vector<double>& times);

// Replaces dates with a time of day, or times of day, by the seconds after the first row:
// "2026-03-01 12:00:01.25", "2026-03-01T12:00:01Z", "01.03.2026 12:00:01,25", "12:00:01",
// "3/1/2026 12:00:01 PM". Times of day go on after midnight. Returns a description of the change;
// nothing if the column has no text, or a text that is neither.
[[nodiscard]] std::optional<std::string> read_stamps(file::Column& column);

// Whether times (s) count from an epoch, such as 1970.
[[nodiscard]] bool counts_from_epoch(const std::vector<double>& times);

}  // namespace bbsim::scenario
