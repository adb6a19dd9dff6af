// Tables of cases, one row a case, in HDF5: what each case gave, as numbers, text and trajectories.
//
// Neither side keeps more than a block of rows, so that parts of a sweep, read block by block, can
// be appended to one table however long it gets.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

enum class CaseKind { number, text, series };

struct CaseColumn {
  std::string name, unit, meaning;
  CaseKind kind = CaseKind::number;
  std::size_t width = 1;  // numbers a case, of a series

  bool operator==(const CaseColumn&) const = default;
};

// Numbers that go along every case's series, such as its times; not a column.
using CaseAxis = std::pair<CaseColumn, std::vector<double>>;

// Some rows, column by column. values[c] is empty for a text, texts[c] for all others. Of a
// series, values[c] holds rows * width numbers, case after case. Texts are UTF-8 without NUL.
struct CaseBlock {
  std::size_t rows = 0;
  std::vector<std::vector<double>> values;
  std::vector<std::vector<std::string>> texts;
};

// Writes HDF5, whole under its final name or not at all. A number is a dataset of one dimension, a
// text one of strings of any length, a series one of cases x width; all grow with the cases. The
// bytes depend on the rows alone, not on the blocks that they came in.
//
// Every function throws OutputError; after that, only destruction may follow.
class CaseTableWriter {
 public:
  // `target` is a regular file or none yet, whatever its name ends in. Of a column, unit and
  // meaning become attributes of its dataset; so they do of an axis, whose kind and width do not
  // count. No two may have the same name. A number called `case` is kept as a whole one, and is the
  // dimension scale of all rows; an axis is that of the series of its length. `inputs` are what the
  // scenario read.
  CaseTableWriter(const std::string& target, const std::vector<CaseColumn>& columns,
                  const std::vector<CaseAxis>& axes = {},
                  const std::vector<InputTable>& inputs = {});
  ~CaseTableWriter();
  CaseTableWriter(CaseTableWriter&&) noexcept;
  CaseTableWriter& operator=(CaseTableWriter&&) noexcept;

  // Appends rows, of which some stay in memory until there are enough to write. A block of
  // another shape than the columns' is an error.
  void append(const CaseBlock& block);

  // Completes the file, with attributes of its root, and puts it under its final name, where it
  // survives a power cut. Without this call nothing stays.
  void finish(const Attributes& attributes);

 private:
  class State;
  std::unique_ptr<State> state_;
};

// Reads such a table, or any other HDF5 file whose root's datasets have one number, string or row
// of numbers a case. Every function throws InputError: what was found, what is allowed.
class CaseTableReader {
 public:
  explicit CaseTableReader(const std::string& file);
  ~CaseTableReader();
  CaseTableReader(CaseTableReader&&) noexcept;
  CaseTableReader& operator=(CaseTableReader&&) noexcept;

  // In the file's order.
  [[nodiscard]] const std::vector<CaseColumn>& columns() const;
  [[nodiscard]] const std::vector<CaseAxis>& axes() const;  // kind number, width 1
  // The root's, those that are a text or a number.
  [[nodiscard]] const Attributes& attributes() const;
  [[nodiscard]] std::size_t rows() const;  // cases
  // What the scenario had read.
  [[nodiscard]] std::vector<InputTable> read_inputs() const;

  // Rows [first, first + count), or as many of them as there are: into.rows tells.
  void read(std::size_t first, std::size_t count, CaseBlock& into) const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace bbsim::file
