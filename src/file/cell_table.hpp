// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables of numbers and text for `bbsim compare`, from runs and sweeps, with the attributes that
// describe the solver.
#pragma once

#include <compare>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

// A place in a file, counted from 1; line 0 means none.
struct Place {
  std::size_t line = 0, column = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};

// A number or a text per row. In the trajectories of a sweep, each row has `width` numbers,
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
  // In a CSV, the places of the first missing value and of the first other text.
  Place first_gap{}, first_text{};

  void add_number(double number);
  void add_text(std::string text);
  // Drops the rows from `count` on, of one number or text each.
  void shorten(std::size_t count);
  [[nodiscard]] std::size_t size() const { return numbers.size(); }
  [[nodiscard]] bool has_text(std::size_t i) const { return !is_text.empty() && is_text[i]; }
};

// Columns by name, in the file's order. Columns that were not requested have a name but no values.
struct CellTable {
  std::vector<std::string> names;
  std::vector<CellColumn> columns;
  std::size_t rows = columns.empty() ? 0 : columns.front().size();
  Attributes attributes{};           // root attributes of an HDF5 file
  std::vector<std::string> units{};  // per column, in an HDF5 file
  std::string file{};                // name of a CSV in messages
  std::vector<std::string> notes{};  // skipped parts: "warning: ..." or "note: ..."

  // The column with this name, or null.
  [[nodiscard]] const CellColumn* find(std::string_view name) const;
};

// Options for reading a CSV.
struct CsvChoice {
  std::vector<std::string> wanted{};  // reads only these columns and t; empty: all
  std::vector<std::string> header{};  // the columns' names, if the file lacks them
};

// Reads an HDF5 file (by its ending) or a CSV; "-" is CSV on standard input. Commas, semicolons or
// tabs separate the fields of a CSV. Fields may be quoted; numbers may have decimal commas. Rows
// may name each field, as in "x:0.01 y:0.02", in place of a header. Skips lines before the header,
// blank lines and lines that start with #. A field that is not a number is text; a missing value is
// empty text. Throws InputError: where, found, allowed.
[[nodiscard]] CellTable read_cells(const std::string& file, const CsvChoice& choice = {});

// Throws read_table()'s InputError for text in a column, at first_gap or first_text.
[[noreturn]] void refuse_text(const CellTable& table, std::size_t column, const Place& place);

}  // namespace bbsim::file
