// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of a stored run: its rows, with straight lines between.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "record/instants.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// A table of a run, whose columns need not be bbsim's own.
class StoredRun {
 public:
  // Throws InputError where the table, of that name, has no t, no rows, or times that fall.
  StoredRun(file::TableData table, const std::string& name);
  StoredRun(const StoredRun&) = delete;  // columns look at this one's names
  StoredRun& operator=(const StoredRun&) = delete;

  // The measures of these names. Throws InputError.
  [[nodiscard]] std::vector<scenario::Measure> measures_named(
      const std::vector<std::string>& names) const;

  // Columns go straight from row to row, and so they begin and end within a window; rms_ is of the
  // rows. What is no finite number is passed over.
  [[nodiscard]] Measured value_of(const scenario::Measure& measure) const;

  // The reference that a step of the column is meant to reach, by its name, if the column has one
  // and the file does not; empty otherwise.
  [[nodiscard]] std::string lacks_reference(const scenario::Measure& measure) const;

  // Of a column that a measure is of.
  [[nodiscard]] const std::vector<double>& values_of(const scenario::Column& column) const;

 private:
  // The rows of a window, and the columns' values at its ends where no row is.
  struct Cut {
    std::size_t first, last;              // rows within it: [first, last)
    std::optional<double> before, after;  // times of its ends, s
  };
  [[nodiscard]] Cut cut_of(const scenario::Window& window) const;
  [[nodiscard]] std::vector<double> cut(const std::vector<double>& values, const Cut& cut) const;

  [[nodiscard]] const scenario::Column* find(std::string_view name) const;

  std::string name_;
  file::TableData table_;
  std::vector<scenario::Column> columns_;
  const std::vector<double>* times_ = nullptr;
};

}  // namespace bbsim::record
