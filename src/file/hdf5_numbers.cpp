// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes and reads HDF5 tables of numbers, for runs.
#include <algorithm>
#include <utility>

#include "base/quoted.hpp"
#include "file/formats.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file {
namespace {

// A slash in a name would create groups: d(x)/d(ball.radius) becomes d(x)_d(ball.radius).
Hdf5Column column_of(const ColumnHeader& header) {
  std::string name(header.name);
  std::ranges::replace(name, '/', '_');
  return {std::move(name), std::string(header.unit), std::string(header.meaning)};
}

class Hdf5Writer final : public TableWriter {
 public:
  Hdf5Writer(const std::string& target, const std::vector<Hdf5Column>& columns)
      : table_(target, columns, {}, Durable::no) {}

  void append(std::span<const double* const> columns, std::size_t rows) override {
    table_.append(columns, rows);
  }
  void add_column(const ColumnHeader& header, const std::vector<double>& values) override {
    table_.add_column(column_of(header), values);
  }
  void keep(const std::vector<InputTable>& inputs) override { table_.keep(inputs); }
  void finish(const Attributes& attributes) override { table_.finish(attributes); }

 private:
  Hdf5TableWriter table_;
};

[[noreturn]] void refuse(const Hdf5TableReader& reader, const std::string& dataset,
                         const char* held) {
  reader.fail("dataset " + shown(dataset) + " is not a column of numbers: it holds " + held);
}

void check_numbers(const Hdf5TableReader& reader) {
  for (const Hdf5Column& column : reader.columns()) {
    if (column.kind == Hdf5Kind::text) refuse(reader, column.name, "text");
    if (column.kind == Hdf5Kind::series) {
      refuse(reader, column.name, "several numbers a row, in two dimensions");
    }
  }
  for (const auto& [axis, values] : reader.axes()) {
    refuse(reader, axis.name, "the axis of other datasets");
  }
}

}  // namespace

std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                       const std::vector<ColumnHeader>& headers) {
  std::vector<Hdf5Column> columns;
  for (const ColumnHeader& header : headers) columns.push_back(column_of(header));
  return std::make_unique<Hdf5Writer>(target, columns);
}

TableData read_hdf5(const std::string& file) {
  Hdf5TableReader reader(file);
  check_numbers(reader);
  TableData table;
  for (const Hdf5Column& column : reader.columns()) table.names.push_back(column.name);
  Hdf5Block block;
  reader.read(block);
  table.columns = std::move(block.values);
  return table;
}

}  // namespace bbsim::file
