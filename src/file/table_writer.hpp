// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Where rows go: CSV, HDF5 or standard output, whole under its final name or not at all.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "file/attributes.hpp"

namespace bbsim::file {

struct ColumnHeader {
  std::string_view name, unit, meaning;
};

// A table, by name, in its file's order. All columns have the same length.
struct TableData {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

// A table that a scenario read, by the name that it has there.
struct InputTable {
  std::string file;
  std::shared_ptr<const TableData> data;
};

class TableWriter {
 public:
  virtual ~TableWriter() = default;

  // Appends `rows` rows given as columns: columns[c][row], one pointer a header.
  // Throws OutputError.
  virtual void append(std::span<const double* const> columns, std::size_t rows) = 0;

  // What only HDF5 has a place for: the tables that the scenario read, and a column that is known
  // only once all rows are there, with a number for each. Throws OutputError.
  virtual void keep(const std::vector<InputTable>& /*inputs*/) {}
  virtual void add_column(const ColumnHeader& /*header*/, const std::vector<double>& /*values*/) {}

  // Completes the file and puts it under its final name. Without this call nothing stays.
  // Throws OutputError.
  virtual void finish(const Attributes& attributes) = 0;
};

// Opens `target`: "-" is CSV on standard output; a name ending in .csv, .h5 or .hdf5 picks the
// format (InputError otherwise). A device or pipe (/dev/full, /dev/stdout, a FIFO) is written
// to directly, as CSV whatever its name. Throws OutputError if the folder cannot be written to.
[[nodiscard]] std::unique_ptr<TableWriter> open_table(const std::string& target,
                                                      const std::vector<ColumnHeader>& headers);

// Throws the InputError of open_table() for a name that picks no format.
void require_table_name(const std::string& target);

// The first line of a CSV with these columns, without its line break.
[[nodiscard]] std::string csv_header(const std::vector<ColumnHeader>& headers);

// Reads a CSV (RFC 4180 without quoting: a header of bare names, then numbers) or, by its
// ending, an HDF5 file; "-" is CSV on standard input. Throws InputError: where, found, allowed.
[[nodiscard]] TableData read_table(const std::string& file);

}  // namespace bbsim::file
