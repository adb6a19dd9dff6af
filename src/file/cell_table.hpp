// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables of numbers and text for `bbsim compare`, from runs and sweeps, with the attributes that
// describe the solver.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

// A number or a text for each row. In the trajectories of a sweep, each row has `width` numbers,
// stored row after row.
struct CellColumn {
  CellColumn() = default;
  CellColumn(std::initializer_list<double> values) : numbers(values) {}
  explicit CellColumn(std::vector<double> values, std::size_t numbers_a_row = 1)
      : numbers(std::move(values)), width(numbers_a_row) {}

  std::vector<double> numbers;  // NaN where there is text
  std::size_t width = 1;
  // Both are empty in a column without text.
  std::vector<std::string> texts{};
  std::vector<bool> is_text{};

  void add_number(double number);
  void add_text(std::string text);
  [[nodiscard]] std::size_t size() const { return numbers.size(); }
  [[nodiscard]] bool has_text(std::size_t i) const { return !is_text.empty() && is_text[i]; }
};

// Columns by name, in the file's order. Columns that were not requested have a name but no values.
struct CellTable {
  std::vector<std::string> names;
  std::vector<CellColumn> columns;
  std::size_t rows = columns.empty() ? 0 : columns.front().size();
  Attributes attributes{};  // of an HDF5 file's root

  // The column with this name, or null.
  [[nodiscard]] const CellColumn* find(std::string_view name) const;
};

// Reads an HDF5 file (by its ending) or a CSV, whose fields may be quoted; "-" is CSV on standard
// input. If `wanted` names columns, reads only these and t from a CSV. A field that is not a number
// is text. Throws InputError: where, found, allowed.
[[nodiscard]] CellTable read_cells(const std::string& file,
                                   const std::vector<std::string>& wanted = {});

}  // namespace bbsim::file
