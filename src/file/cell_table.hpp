// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables as `bbsim compare` sees them: numbers and texts, of runs and of sweeps, with what their
// files say of the solver.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

// One number or text a row; or, of a sweep's trajectories, `width` numbers a row, row after row.
struct CellColumn {
  CellColumn() = default;
  CellColumn(std::initializer_list<double> values) : numbers(values) {}
  explicit CellColumn(std::vector<double> values, std::size_t numbers_a_row = 1)
      : numbers(std::move(values)), width(numbers_a_row) {}

  std::vector<double> numbers;  // NaN where there is a text
  std::size_t width = 1;
  // Both are empty in a column without a single text.
  std::vector<std::string> texts{};
  std::vector<bool> is_text{};

  void add_number(double number);
  void add_text(std::string text);
  [[nodiscard]] std::size_t size() const { return numbers.size(); }
  [[nodiscard]] bool has_text(std::size_t i) const { return !is_text.empty() && is_text[i]; }
};

// By name, in the file's order. Columns that nobody asked for are named, and empty.
struct CellTable {
  std::vector<std::string> names;
  std::vector<CellColumn> columns;
  std::size_t rows = columns.empty() ? 0 : columns.front().size();
  Attributes attributes{};  // of an HDF5 file's root

  // The column of that name, or null.
  [[nodiscard]] const CellColumn* find(std::string_view name) const;
};

// Reads a CSV, in which fields may be quoted, or, by its ending, an HDF5 file; "-" is CSV on
// standard input. If `wanted` names columns, no others are read from a CSV, but for t. A field that
// is no number is a text. Throws InputError: where, found, allowed.
[[nodiscard]] CellTable read_cells(const std::string& file,
                                   const std::vector<std::string>& wanted = {});

}  // namespace bbsim::file
