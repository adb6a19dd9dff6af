// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables of numbers and texts: runs, sweeps, and logs of rigs. The one reader of files.
#pragma once

#include <compare>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "file/attributes.hpp"

namespace bbsim::file {

// A place in a file, counted from 1; line 0 means none.
struct Place {
  std::size_t line = 0, column = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};

// A number or a text per row. In the trajectories of a sweep, each row has `width` numbers,
// stored row after row.
struct Column {
  std::string name;
  std::vector<double> numbers;       // NaN where there is a text or nothing
  std::vector<std::string> texts{};  // empty if all fields are numbers; not of a number
  std::string unit{};                // from its file; empty if unknown
  std::size_t width = 1;
  Place first_text{};  // in a CSV, of the first field that is neither a number nor missing

  // Whether some field is neither a number nor missing.
  [[nodiscard]] bool is_text() const;
  // Whether a field is a text, or missing in a column that is not all numbers.
  [[nodiscard]] bool has_text(std::size_t i) const;
  // The field as text; empty for NaN.
  [[nodiscard]] std::string text(std::size_t i) const;
  void add_text(std::string text);
  // Keeps the rows with these indices, in this order.
  void keep(const std::vector<std::size_t>& rows);
};

// Columns in the file's order. Columns that were not requested have a name but no values.
struct Table {
  Table() = default;
  Table(const std::vector<std::string>& names, std::vector<std::vector<double>> numbers);
  explicit Table(std::vector<Column> its_columns);

  std::string file{};  // as the user wrote it; empty for a table in memory
  std::vector<Column> columns{};
  std::size_t rows = 0;
  Attributes attributes{};           // root attributes of an HDF5 file
  std::vector<std::string> notes{};  // what was left out or changed: "warning: ..." or "note: ..."

  // The column with this name, or null.
  [[nodiscard]] const Column* find(std::string_view name) const;
  [[nodiscard]] Column* find(std::string_view name);
  [[nodiscard]] std::vector<std::string> names() const;
  // Removes the columns of texts, and returns them.
  std::vector<Column> take_texts();
};

// A table that a scenario read, under the file name in the scenario.
struct InputTable {
  std::string file;
  std::shared_ptr<const Table> data;
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
[[nodiscard]] Table read_table(const std::string& file, const CsvChoice& choice = {});

// Throws InputError for the first text of a column of the file: where, found, allowed.
[[noreturn]] void refuse_text(const std::string& file, const Column& column);

// The most bytes of a field or a name in messages.
inline constexpr std::size_t longest_name = 40;

}  // namespace bbsim::file
