// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes and reads HDF5 tables of numbers, texts and series: a run with one row per time, or a
// sweep with one row per case.
//
// Reader and writer hold at most one block of rows in memory, so that parts of a sweep can be
// merged into one table of any length.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/atomic_file.hpp"
#include "file/hdf5_process.hpp"
#include "file/table_writer.hpp"

namespace bbsim::file {

enum class Hdf5Kind { number, text, series };

struct Hdf5Column {
  std::string name, unit, meaning;
  Hdf5Kind kind = Hdf5Kind::number;
  // Series: numbers per row. Text: largest length in bytes; 1 means any length.
  std::size_t width = 1;

  bool operator==(const Hdf5Column&) const = default;
};

// Numbers that belong to the series of every row, such as their times. Not a column.
using Hdf5Axis = std::pair<Hdf5Column, std::vector<double>>;

// Some rows, column by column. values[c] is empty in a text column, texts[c] in all others. For a
// series, values[c] holds rows * width numbers, row after row. Texts are UTF-8 without NUL.
struct Hdf5Block {
  std::size_t rows = 0;
  std::vector<std::vector<double>> values;
  std::vector<std::vector<std::string>> texts;
};

// Writes an HDF5 file that appears whole under its final name, or not at all. Each column is an
// extendible dataset: 1-D numbers, 1-D strings, or rows x width for a series. Tables of cases are
// compressed if the HDF5 library can. The bytes depend on the rows only, not on the blocks.
//
// Every function throws OutputError; the object may then only be destroyed.
class Hdf5TableWriter {
 public:
  // `target` is a regular file or does not exist; its ending is arbitrary. Unit and meaning become
  // attributes of the dataset. The kind and width of an axis are ignored. All names must differ.
  // The number column `case` (stored as integers), or `t` without one, is the dimension scale of
  // the rows. An axis is the scale of all series of its length. `durable`: whether the finished
  // file survives a power cut.
  Hdf5TableWriter(const std::string& target, const std::vector<Hdf5Column>& columns,
                  const std::vector<Hdf5Axis>& axes = {}, Durable durable = Durable::yes);
  ~Hdf5TableWriter();
  Hdf5TableWriter(Hdf5TableWriter&&) noexcept;
  Hdf5TableWriter& operator=(Hdf5TableWriter&&) noexcept;

  // Appends rows. Some stay in memory until there are enough to write. The block must have the
  // shape of the columns.
  void append(const Hdf5Block& block);
  // The same for a table of numbers only: columns[c][row].
  void append(std::span<const double* const> columns, std::size_t rows);

  // Adds a column of numbers after the last row.
  void add_column(const Hdf5Column& column, const std::vector<double>& values);
  // Stores the tables that the scenario read.
  void keep(const std::vector<InputTable>& inputs);

  // Sets root attributes, completes the file and puts it under its final name. Without this call no
  // file remains.
  void finish(const Attributes& attributes);

 private:
  class State;
  std::unique_ptr<State> state_;
};

// Reads such a table from front to back, or any other HDF5 file whose root datasets have one
// number, string or row of numbers per row. Every function throws InputError: found, allowed.
class Hdf5TableReader {
 public:
  explicit Hdf5TableReader(const std::string& file, const Hdf5Rows& rows = {});

  // The columns, in the file's order.
  [[nodiscard]] const std::vector<Hdf5Column>& columns() const { return columns_; }
  // The axes, with kind number and width 1.
  [[nodiscard]] const std::vector<Hdf5Axis>& axes() const { return axes_; }
  // The root attributes that are a text or a number.
  [[nodiscard]] const Attributes& attributes() const { return attributes_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }  // all rows, read or not

  // Reads the next block of rows. Returns false, with no rows, after the last.
  bool read(Hdf5Block& into);
  // Returns the tables that the scenario read. Call it once. Skips the remaining rows.
  [[nodiscard]] std::vector<InputTable> read_inputs();

  [[noreturn]] void fail(std::string_view reason) const;

 private:
  friend class Hdf5TableReaders;

  struct InputHead {
    std::string file;
    std::vector<std::string> columns;
    std::size_t rows = 0;
  };

  Hdf5TableReader(std::string file, const Hdf5Rows& rows, std::shared_ptr<Hdf5Process> process);
  void read_head();
  void take_numbers(std::size_t count, std::vector<double>& numbers);
  void take_texts(std::size_t count, std::vector<std::string>& texts);

  std::string file_;
  std::size_t a_block_;
  std::shared_ptr<Hdf5Process> process_;
  std::vector<Hdf5Column> columns_;
  std::vector<Hdf5Axis> axes_;
  Attributes attributes_;
  std::vector<InputHead> inputs_;
  std::size_t rows_ = 0, left_ = 0;
};

// Reads many files with one process, which is faster than a process for each.
class Hdf5TableReaders {
 public:
  explicit Hdf5TableReaders(std::vector<std::string> files, const Hdf5Rows& rows = {});

  // Returns the reader of the next file. Read the inputs of the previous file first.
  [[nodiscard]] Hdf5TableReader next();

 private:
  std::vector<std::string> files_;
  Hdf5Rows rows_;
  std::shared_ptr<Hdf5Process> process_;
  std::size_t next_ = 0;
};

}  // namespace bbsim::file
