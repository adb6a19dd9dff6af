// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes and reads HDF5 tables of numbers, texts and series: a run with one row per time, or a
// sweep with one row per case.
//
// Reader and writer hold at most one block of rows in memory, so that parts of a sweep can be
// merged into one table of any length.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file/atomic_file.hpp"
#include "file/table_writer.hpp"

namespace bbsim::file {

namespace hdf5 {
class Writer;
class Reader;
struct Module;
struct Trouble;
}  // namespace hdf5

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

// What a file says before its rows.
struct Hdf5Head {
  std::vector<Hdf5Column> columns;  // in the file's order
  std::vector<Hdf5Axis> axes;       // with kind number and width 1
  Attributes attributes;            // of the root: those that are a text or a number
  std::size_t rows = 0;
};

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
class Hdf5TableWriter final : public TableWriter {
 public:
  // `target` is a regular file or does not exist; its ending is arbitrary. Unit and meaning become
  // attributes of the dataset. The kind and width of an axis are ignored. All names must differ;
  // each `/` becomes `_`, because HDF5 would create groups. The number column `case` (stored as
  // integers), or `t` without one, is the dimension scale of the rows. An axis is the scale of all
  // series of its length. `durable`: whether the finished file survives a power cut.
  Hdf5TableWriter(const std::string& target, const std::vector<Hdf5Column>& columns,
                  const std::vector<Hdf5Axis>& axes = {}, Durable durable = Durable::yes);
  ~Hdf5TableWriter() override;

  // Appends rows. Some stay in memory until there are enough to write. The block must have the
  // shape of the columns.
  void append(const Hdf5Block& block);
  void append(std::span<const double* const> columns, std::size_t rows) override;
  void add_column(const ColumnHeader& header, const std::vector<double>& values) override;
  void keep(const std::vector<InputTable>& inputs) override;
  void finish(const Attributes& attributes) override;

 private:
  void flush();
  [[nodiscard]] hdf5::Writer& open_writer();
  void check(const hdf5::Trouble& trouble);

  std::string target_;
  std::vector<Hdf5Column> columns_;
  std::size_t rows_at_once_, rows_ = 0;
  Hdf5Block waiting_;
  AtomicFile file_;
  std::unique_ptr<hdf5::Writer> writer_;
};

// Throws OutputError if this program cannot write HDF5.
void require_hdf5(const std::string& target);

// Reads such a table from front to back, or any other HDF5 file whose root datasets have one
// number, string or row of numbers per row. Every function throws InputError: found, allowed.
class Hdf5TableReader {
 public:
  static constexpr std::size_t all_rows = std::numeric_limits<std::size_t>::max();

  explicit Hdf5TableReader(const std::string& file, std::size_t rows_a_block = all_rows);
  ~Hdf5TableReader();
  Hdf5TableReader(Hdf5TableReader&&) noexcept;

  [[nodiscard]] const Hdf5Head& head() const { return head_; }
  [[nodiscard]] const std::vector<Hdf5Column>& columns() const { return head_.columns; }
  [[nodiscard]] std::size_t rows() const { return head_.rows; }  // all rows, read or not

  // Reads the next block of rows. Returns false, with no rows, after the last.
  bool read(Hdf5Block& into);
  // Returns the tables that the scenario read.
  [[nodiscard]] std::vector<InputTable> read_inputs();

  [[noreturn]] void fail(std::string_view reason) const;

 private:
  void check(const hdf5::Trouble& trouble) const;

  std::string file_;
  std::size_t rows_a_block_, next_ = 0;
  Hdf5Head head_;
  std::unique_ptr<hdf5::Reader> reader_;
};

// The HDF5 module, which writes and reads the files; or, in `trouble`, why it is missing and the
// remedy, as the end of a sentence.
struct Hdf5Module {
  const hdf5::Module* functions = nullptr;
  std::string trouble;
};

// Looks for the module in these folders, in order, and opens it; it is never closed.
[[nodiscard]] Hdf5Module open_hdf5_module(const std::vector<std::string>& folders);

// The folders to search: BBSIM_MODULE_PATH alone, if it is set; otherwise those above the
// shared library with this code, or ../lib/bbsim (or the system's name for lib) of the program.
[[nodiscard]] std::vector<std::string> hdf5_module_folders();

}  // namespace bbsim::file
