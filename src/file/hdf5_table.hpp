// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tables in HDF5, of numbers, texts and series: a run, a number a column at each time; or a sweep,
// what each case gave.
//
// Neither side keeps more than a block of rows, so that parts of a sweep, read block by block, can
// be appended to one table however long it gets.
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
  // Numbers a row, of a series; of a text, the most bytes of each, or 1: any number of them.
  std::size_t width = 1;

  bool operator==(const Hdf5Column&) const = default;
};

// Numbers that go along every row's series, such as its times; not a column.
using Hdf5Axis = std::pair<Hdf5Column, std::vector<double>>;

// Some rows, column by column. values[c] is empty for a text, texts[c] for all others. Of a
// series, values[c] holds rows * width numbers, row after row. Texts are UTF-8 without NUL.
struct Hdf5Block {
  std::size_t rows = 0;
  std::vector<std::vector<double>> values;
  std::vector<std::vector<std::string>> texts;
};

// Writes HDF5, whole under its final name or not at all. A number is a dataset of one dimension, a
// text one of strings, a series one of rows x width; all grow with the rows. Those of cases are
// compressed, where HDF5 can. The bytes depend on the rows alone, not on the blocks that they came
// in.
//
// Every function throws OutputError; after that, only destruction may follow.
class Hdf5TableWriter {
 public:
  // `target` is a regular file or none yet, whatever its name ends in. Of a column, unit and
  // meaning become attributes of its dataset; so they do of an axis, whose kind and width do not
  // count. No two may have the same name. A number called `case`, kept as a whole one, is the
  // dimension scale of all rows, or one called `t` where there are no cases; an axis is that of the
  // series of its length. `durable`: it survives a power cut once it is finished.
  Hdf5TableWriter(const std::string& target, const std::vector<Hdf5Column>& columns,
                  const std::vector<Hdf5Axis>& axes = {}, Durable durable = Durable::yes);
  ~Hdf5TableWriter();
  Hdf5TableWriter(Hdf5TableWriter&&) noexcept;
  Hdf5TableWriter& operator=(Hdf5TableWriter&&) noexcept;

  // Appends rows, of which some stay in memory until there are enough to write. A block of
  // another shape than the columns' is an error.
  void append(const Hdf5Block& block);
  // The same of a table of numbers alone: columns[c][row].
  void append(std::span<const double* const> columns, std::size_t rows);

  // Adds a column of numbers that is known only once all rows are there.
  void add_column(const Hdf5Column& column, const std::vector<double>& values);
  // Keeps what the scenario read.
  void keep(const std::vector<InputTable>& inputs);

  // Completes the file, with attributes of its root, and puts it under its final name. Without
  // this call nothing stays.
  void finish(const Attributes& attributes);

 private:
  class State;
  std::unique_ptr<State> state_;
};

// Reads such a table, or any other HDF5 file whose root's datasets have one number, string or row
// of numbers a row, from front to back. Every function throws InputError: what was found, what is
// allowed.
class Hdf5TableReader {
 public:
  explicit Hdf5TableReader(const std::string& file, const Hdf5Rows& rows = {});

  // In the file's order.
  [[nodiscard]] const std::vector<Hdf5Column>& columns() const { return columns_; }
  // Their kind is number, their width 1.
  [[nodiscard]] const std::vector<Hdf5Axis>& axes() const { return axes_; }
  // The root's, those that are a text or a number.
  [[nodiscard]] const Attributes& attributes() const { return attributes_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }  // cases, read or not

  // The next block of rows. False, and none, after the last.
  bool read(Hdf5Block& into);
  // What the scenario had read: to be asked for once. Skips the rows that are left.
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

// Reads many files by one process, which takes less time than a process for each.
class Hdf5TableReaders {
 public:
  explicit Hdf5TableReaders(std::vector<std::string> files, const Hdf5Rows& rows = {});

  // The next file's, once the inputs of the one before were read.
  [[nodiscard]] Hdf5TableReader next();

 private:
  std::vector<std::string> files_;
  Hdf5Rows rows_;
  std::shared_ptr<Hdf5Process> process_;
  std::size_t next_ = 0;
};

}  // namespace bbsim::file
