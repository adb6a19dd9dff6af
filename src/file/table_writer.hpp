// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes tables to CSV, HDF5 or standard output, in the format of the file's name.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "file/table.hpp"

namespace bbsim::file {

struct ColumnHeader {
  std::string_view name, unit, meaning;
};

class TableWriter {
 public:
  virtual ~TableWriter() = default;

  // Appends rows given by columns: columns[c][row], with one pointer for each header. Throws
  // OutputError.
  virtual void append(std::span<const double* const> columns, std::size_t rows) = 0;

  // Only HDF5 can hold these: the tables that the scenario read, and a column that becomes known
  // after the last row, with one number for each row. Both throw OutputError.
  virtual void keep(const std::vector<InputTable>& /*inputs*/) {}
  virtual void add_column(const ColumnHeader& /*header*/, const std::vector<double>& /*values*/) {}

  // Completes the file and puts it under its final name. Without this call no file remains. Throws
  // OutputError.
  virtual void finish(const Attributes& attributes) = 0;
};

// Opens `target`. "-" is CSV on standard output. Otherwise the ending picks the format: .csv, .h5
// or .hdf5 (other endings: InputError). A device or pipe (/dev/full, /dev/stdout, a FIFO) is
// written directly, as CSV whatever its name. Throws OutputError if the folder is not writable.
[[nodiscard]] std::unique_ptr<TableWriter> open_table(const std::string& target,
                                                      const std::vector<ColumnHeader>& headers);

// Throws open_table()'s InputError if the name picks no format.
void require_table_name(const std::string& target);

// The first line of a CSV with these columns, without its line break.
[[nodiscard]] std::string csv_header(const std::vector<ColumnHeader>& headers);

enum class Format { csv, hdf5, other };

// Decides by the ending, in upper or lower case: .csv, .h5, .hdf5.
[[nodiscard]] Format format_of(const std::string& file);

// The ending in lower case: ".svg" for "a.SVG".
[[nodiscard]] std::string lower_ending(const std::string& file);

// Only open_table() and read_table() use these. The writer throws OutputError, readers InputError.
[[nodiscard]] std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                                     const std::vector<ColumnHeader>& headers);
[[nodiscard]] Table read_csv(const std::string& file, const CsvChoice& choice);
[[nodiscard]] Table read_hdf5(const std::string& file);

}  // namespace bbsim::file
