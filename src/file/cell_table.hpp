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

// A place in a file, from 1; line 0 is none.
struct Place {
  std::size_t line = 0, column = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};

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
  // In a CSV, the first empty field, and the first other text.
  Place first_gap{}, first_text{};

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
  Attributes attributes{};           // of an HDF5 file's root
  std::vector<std::string> units{};  // of an HDF5 file's columns
  std::string file{};                // its name in messages, of a CSV
  std::vector<std::string> notes{};  // what was left out: "warning: ..." or "note: ..."

  // The column with this name, or null.
  [[nodiscard]] const CellColumn* find(std::string_view name) const;
};

// What to read of a CSV.
struct CsvChoice {
  std::vector<std::string> wanted{};  // only these columns and t; none: all
  std::vector<std::string> header{};  // the columns' names, if the file does not have them
};

// Reads an HDF5 file (by its ending) or a CSV; "-" is CSV on standard input. Commas, semicolons or
// tabs separate the fields of a CSV, which may be quoted; numbers may have decimal commas. Lines
// before the header, blank lines and lines that start with # are left out. A field that is not a
// number is text; of a missing value, an empty one. Throws InputError: where, found, allowed.
[[nodiscard]] CellTable read_cells(const std::string& file, const CsvChoice& choice = {});

// Throws read_table()'s InputError for a text in a column, at first_gap or first_text.
[[noreturn]] void refuse_text(const CellTable& table, std::size_t column, const Place& place);

}  // namespace bbsim::file
