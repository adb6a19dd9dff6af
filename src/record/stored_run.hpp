// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of a stored run: its rows, with straight lines between them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "file/table.hpp"
#include "record/instants.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// The table of a run, of columns of numbers. They need not be known to bbsim.
class StoredRun {
 public:
  // `name` is the file's name in messages. Throws InputError if the table has no t, no rows, or
  // times that decrease or are not finite.
  StoredRun(file::Table table, const std::string& name);
  StoredRun(const StoredRun&) = delete;  // columns_ refer to the names in table_
  StoredRun& operator=(const StoredRun&) = delete;

  // The measures with these names. Throws InputError.
  [[nodiscard]] std::vector<scenario::Measure> measures_named(
      const std::vector<std::string>& names) const;

  // Interpolates columns linearly between rows that have a number, also at the ends of a window;
  // rms_ uses rows only.
  [[nodiscard]] Measured value_of(const scenario::Measure& measure) const;

  // The name of the reference that a step of the column should reach, if the file lacks it; empty
  // otherwise.
  [[nodiscard]] std::string lacks_reference(const scenario::Measure& measure) const;

  // The values of a column that a measure refers to.
  [[nodiscard]] const std::vector<double>& values_of(const scenario::Column& column) const;

 private:
  // Rows of a window, and its ends if no row lies there.
  struct Cut {
    std::size_t first, last;              // rows within it: [first, last)
    std::optional<double> before, after;  // times of its ends, s, if interpolation is needed there
  };
  [[nodiscard]] Cut cut_of(const scenario::Window& window) const;
  // The column with numbers for those that it lacks between others.
  [[nodiscard]] std::vector<double> filled(const scenario::Column& column) const;
  [[nodiscard]] std::vector<double> cut(const std::vector<double>& values, const Cut& cut) const;

  [[nodiscard]] const scenario::Column* find(std::string_view name) const;

  std::string name_;
  file::Table table_;
  std::vector<scenario::Column> columns_;
  const std::vector<double>* times_ = nullptr;
};

}  // namespace bbsim::record
